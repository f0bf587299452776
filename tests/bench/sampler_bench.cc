// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "daemon/acquire/sampler.h"
#include "tests/unit/daemon/serve/streams.h"

namespace {

using namespace mgtd;

/// Four free-running 50 Hz devices, 16 ms of delivery jitter, clocks settled: readings in, epochs out.
void sampler_push(benchmark::State& state) {
  std::array<test::DeviceSim, kSensors> devices;
  for (std::size_t i = 0; i < kSensors; ++i) {
    devices[i].ppm = 40.0 * static_cast<double>(i) - 60;
    devices[i].phase_s = 0.0047 * static_cast<double>(i);
    devices[i].delay_s = test::uniform_delay(0.016, i);
  }
  const auto readings = test::merged(devices, 1000);
  std::int64_t epochs = 0;
  std::vector<EpochOrGap> out;
  for (auto _ : state) {
    mgtd::daemon::acquire::Sampler sampler({});
    for (const FieldReading& reading : readings) {
      sampler.push(reading, out);
      epochs += static_cast<std::int64_t>(out.size());
      out.clear();
    }
  }
  state.SetItemsProcessed(epochs);  // epochs per second; one epoch is four readings
}
BENCHMARK(sampler_push)->Unit(benchmark::kMillisecond);

}  // namespace
