// SPDX-License-Identifier: Apache-2.0
// Epoch in, tensor with standard deviations and closure chi-square out. Target: more than 500 000 epochs a
// second.
#include <benchmark/benchmark.h>

#include "calib/calibration/tensor.h"

namespace mgtd::calib {
namespace {

calibration::Calibration calibration() {
  calibration::Calibration c;
  for (std::size_t i = 0; i < kSensors; ++i) {
    const double s = 0.01 * static_cast<double>(i + 1);
    sensor::ParameterVector p;
    p << s, -2 * s, 1.5 * s, 1 + s, 1 - s, 1 + 2 * s, 100 * s, -5000 * s, 300, -s, 2 * s, 3 * s;
    c.sensors[i] = sensor::SensorModel::from_parameters(p);
  }
  c.sample_noise_nT.setConstant(0.3);
  c.covariance.diagonal().setConstant(1e-10);
  c.seal();
  return c;
}

void tensor_pipeline(benchmark::State& state) {
  const auto shared = std::make_shared<calibration::Calibration>(calibration());
  const calibration::TensorPipeline pipeline(shared);
  Epoch epoch;
  for (std::size_t i = 0; i < kSensors; ++i)
    epoch.y_nT[i] = shared->sensors[i].predict({20'000, 3'000, 45'000});
  for (auto _ : state) {
    epoch.y_nT[0][0] += 1e-3;
    TensorSample sample = pipeline.apply(epoch);
    benchmark::DoNotOptimize(sample.closure.chi2);
    benchmark::DoNotOptimize(sample.g_sd_nT_per_m);
    ++epoch.seq;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(tensor_pipeline);

/// What a change of the active calibration costs.
void tensor_pipeline_prepare(benchmark::State& state) {
  const auto shared = std::make_shared<calibration::Calibration>(calibration());
  for (auto _ : state) {
    calibration::TensorPipeline pipeline(shared);
    benchmark::DoNotOptimize(pipeline);
  }
}
BENCHMARK(tensor_pipeline_prepare)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mgtd::calib
