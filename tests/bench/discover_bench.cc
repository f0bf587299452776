// SPDX-License-Identifier: Apache-2.0
// Cost of a search for a law of no library with its 2000 draws, on 157 poses: where nothing is there, where
// one formula accounts for everything, and where the law first looks like noise that lasts from pose to pose.
#include <benchmark/benchmark.h>

#include <cmath>

#include "calib/discovery/discover.h"
#include "tests/blind/hidden_law.h"

namespace mgtd::calib::testing {
namespace {

void discover_157(benchmark::State& state, const Hidden& hidden) {
  const PoseTable table = hidden_run({.hidden = hidden}, 1);
  std::size_t formulas = 0;
  for (auto _ : state) {
    const auto report = discovery::discover(table, {});
    if (!report) return state.SkipWithError(report.error().text().c_str());
    formulas = report->formulas;
  }
  state.counters["formulas"] = static_cast<double>(formulas);
}

void discover_clean(benchmark::State& state) { discover_157(state, {}); }
void discover_fourth_power(benchmark::State& state) {
  discover_157(state, [](const Pose&, int sensor, int axis, const Eigen::Vector3d& v) {
    return sensor == 1 && axis == 2 ? 20 * std::pow(v[axis] / 50'000, 4) : 0;
  });
}
void discover_lasting(benchmark::State& state) {
  discover_157(state, [](const Pose& p, int sensor, int axis, const Eigen::Vector3d&) {
    return sensor == 1 && axis == 2 ? 5 * std::sin(*p.t_s / 600) : 0;
  });
}
BENCHMARK(discover_clean)->Unit(benchmark::kMillisecond);
BENCHMARK(discover_fourth_power)->Unit(benchmark::kMillisecond);
BENCHMARK(discover_lasting)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mgtd::calib::testing
