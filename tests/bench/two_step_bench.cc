// SPDX-License-Identifier: Apache-2.0
// Both steps for four sensors: the estimate alone (target: 157 poses under 1 ms), and the whole report with
// its covariance, held-out folds and halves.
#include <benchmark/benchmark.h>

#include "calib/fit/method_choice/fit.h"
#include "calib/fit/two_step/two_step.h"
#include "tests/support/paper_rigs.h"

namespace mgtd::calib {
namespace {

PoseTable poses(std::int64_t count) {
  const auto attitudes = count == 5832 ? testing::grid_5832() : testing::standard_run(121, 1);
  return testing::measure(testing::table6_rig(), {53'907.7, 60, -5}, attitudes, count == 5832 ? 18 : 36,
                          {testing::Noise::Kind::gaussian, 1.0, 0.1, 0.05}, 3);
}

void two_step_estimate(benchmark::State& state) {
  const fit::FitOptions options;
  const auto readings = fit::readings_of(poses(state.range(0)), options);
  for (auto _ : state) {
    auto fitted = fit::two_step::two_step(*readings, options);
    if (!fitted) return state.SkipWithError(fitted.error().text().c_str());
    benchmark::DoNotOptimize(fitted->sensors);
  }
}
BENCHMARK(two_step_estimate)->ArgName("poses")->Arg(157)->Arg(5832)->Unit(benchmark::kMicrosecond);

void two_step_report(benchmark::State& state) {
  const PoseTable table = poses(state.range(0));
  for (auto _ : state) {
    auto report = fit::method_choice::fit(table, {});
    if (!report) return state.SkipWithError(report.error().text().c_str());
    benchmark::DoNotOptimize(report->chi2);
  }
}
BENCHMARK(two_step_report)->ArgName("poses")->Arg(157)->Arg(5832)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mgtd::calib
