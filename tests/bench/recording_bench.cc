// SPDX-License-Identifier: Apache-2.0
// A recording of one sensor turned by hand, 26 000 samples: its fit is to take less than 0.3 s, and explain
// less than 5 s. The argument is the correlation of neighbouring samples in percent.
#include <benchmark/benchmark.h>

#include "tests/unit/calib/fit/fitted_arrays.h"

namespace mgtd::calib::testing {
namespace {

PoseTable recording(const benchmark::State& state) {
  const double ar = static_cast<double>(state.range(0)) / 100;
  return rig::pose_table_of(rig::simulated_recording(scenario_of(
      one_sensor(), 1,
      fmt::format("[recording]\nmotion = \"hand\"\nrate_hz = 200\nduration_s = 130\nar = {}\n", ar))));
}

void recording_fit(benchmark::State& state) {
  const PoseTable table = recording(state);
  for (auto _ : state) {
    const auto report = fit::method_choice::fit(table, options_of(one_sensor()));
    if (!report) return state.SkipWithError(report.error().text().c_str());
  }
  state.counters["samples"] = static_cast<double>(table.poses.size());
}

void recording_explain(benchmark::State& state) {
  const PoseTable table = recording(state);
  criticism::search::ExplainOptions asked;
  asked.fit = options_of(one_sensor());
  for (auto _ : state) {
    const auto report = criticism::search::explain(table, asked);
    if (!report) return state.SkipWithError(report.error().text().c_str());
  }
}

BENCHMARK(recording_fit)->ArgName("percent")->Arg(0)->Arg(90)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(recording_explain)
    ->ArgName("percent")
    ->Arg(0)
    ->Arg(90)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace mgtd::calib::testing
