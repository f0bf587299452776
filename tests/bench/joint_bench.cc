// SPDX-License-Identifier: Apache-2.0
// Cost of the joint fit against the number of poses, covariance included.
#include <benchmark/benchmark.h>

#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib {
namespace {

PoseTable poses(int count, bool with_gradient) {
  testing::Simulation sim{.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05, .f_drift_nT = 30};
  if (with_gradient) sim.G_nT_per_m = testing::gradient_50();
  return simulate(sim, count * 36 / 157, count - count * 36 / 157, 1);
}

/// Everything: start, noise, table, outliers, covariance.
void joint(benchmark::State& state) {
  const bool with_gradient = state.range(1) != 0;
  const PoseTable table = poses(static_cast<int>(state.range(0)), with_gradient);
  fit::joint::JointOptions options;
  if (with_gradient) options.effects = {*effects::library::make_effect("site.gradient")};
  int iterations = 0;
  for (auto _ : state) {
    const auto fit = fit::joint::fit_joint(table, options);
    if (!fit) return state.SkipWithError(fit.error().text().c_str());
    iterations = fit->iterations;
  }
  state.counters["iterations"] = iterations;
  state.SetComplexityN(state.range(0));
}
BENCHMARK(joint)
    ->ArgNames({"poses", "gradient"})
    ->ArgsProduct({{157, 500, 5832, 100'000}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

/// One effect of the library in the model, 157 poses with temperatures.
void joint_with(benchmark::State& state, const char* spec) {
  PoseTable table = poses(157, false);
  for (Pose& pose : table.poses) {
    for (std::size_t i = 0; i < kSensors; ++i)
      pose.T_degC[i] = 25 + 3 * std::sin(0.1 * pose.number + static_cast<double>(i));
  }
  fit::joint::JointOptions options;
  options.effects = {*effects::library::make_effect(spec)};
  for (auto _ : state) {
    const auto fit = fit::joint::fit_joint(table, options);
    if (!fit) return state.SkipWithError(fit.error().text().c_str());
  }
}
BENCHMARK_CAPTURE(joint_with, one_axis, "axis.offset.temperature@s3.z")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(joint_with, twelve_axes, "axis.offset.temperature")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(joint_with, twenty_four, "axis.transverse")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(joint_with, hysteresis, "axis.hysteresis,w=0.1")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(joint_with, flexure, "platform.flexure")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mgtd::calib
