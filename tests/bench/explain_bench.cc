// SPDX-License-Identifier: Apache-2.0
// Cost of asking what is missing, on 157 poses: explain with its draws over the whole library, improve of
// four rounds.
#include <benchmark/benchmark.h>

#include "calib/criticism/search/improve.h"
#include "tests/blind/hidden_law.h"

namespace mgtd::calib::testing {
namespace {

/// Four laws on four axes, each far above the noise.
Hidden four_laws() {
  return [](const Pose& p, int sensor, int axis, const Eigen::Vector3d& v) {
    const double x = v[axis] / 50'000;
    if (sensor == 0 && axis == 2) return 8 * x * x * x;
    if (sensor == 1 && axis == 0) return 0.8 * (*p.T_degC[1] - 20);
    if (sensor == 2 && axis == 1) return 4 * *p.t_s / 3600;
    return sensor == 3 && axis == 0 ? (x > 0 ? 1.5 : -1.5) : 0;
  };
}

void explain_157(benchmark::State& state, const Hidden& hidden) {
  const PoseTable table = hidden_run({.hidden = hidden}, 1);
  std::size_t tested = 0;
  for (auto _ : state) {
    const auto report = criticism::search::explain(table, {});
    if (!report) return state.SkipWithError(report.error().text().c_str());
    tested = report->candidates.size();
  }
  state.counters["effects"] = static_cast<double>(tested);
}

void explain_clean(benchmark::State& state) { explain_157(state, {}); }
void explain_one_hidden(benchmark::State& state) {
  explain_157(state, hide(hidden_laws()[5], 0, 2, 10));  // a cubic
}
BENCHMARK(explain_clean)->Unit(benchmark::kMillisecond);
BENCHMARK(explain_one_hidden)->Unit(benchmark::kMillisecond);

void improve_four(benchmark::State& state) {
  const PoseTable table = hidden_run({.hidden = four_laws()}, 1);
  std::size_t rounds = 0;
  for (auto _ : state) {
    const auto report = criticism::search::improve(table, {});
    if (!report) return state.SkipWithError(report.error().text().c_str());
    rounds = report->rounds.size();
  }
  state.counters["rounds"] = static_cast<double>(rounds);
}
BENCHMARK(improve_four)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mgtd::calib::testing
