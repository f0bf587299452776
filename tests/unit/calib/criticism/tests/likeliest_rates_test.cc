// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/likeliest_rates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "calib/criticism/tests/residual.h"
#include "tests/unit/calib/fit/arrays_of_any_size.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kRate_nT_per_sqrt_h = 60, kRate_hz = 80, kWhite_nT = 0.5;

/// A recording of a sensor whose offsets walk.
PoseTable walking(double seconds) {
  const auto scenario = mgtd::calib::testing::scenario_of(
      mgtd::calib::testing::one_sensor(), 5,
      fmt::format(
          "[sensors]\nnoise_nT = {}\n[recording]\nmotion = \"hand\"\nrate_hz = {}\nduration_s = {}\nar = 0\n",
          kWhite_nT, kRate_hz, seconds));
  PoseTable table = rig::pose_table_of(rig::simulated_recording(scenario));
  std::mt19937_64 random(1);
  std::normal_distribution<double> step(0, kRate_nT_per_sqrt_h * std::sqrt(1 / kRate_hz / 3600));
  Eigen::Vector3d offset_nT = Eigen::Vector3d::Zero();
  for (Pose& pose : table.poses) {
    for (double& axis : offset_nT) axis += step(random);
    pose.y_nT[0] += offset_nT;
  }
  return table;
}

auto fitted(const PoseTable& table) {
  fit::joint::JointOptions options;
  options.geometry = mgtd::calib::testing::geometry_of(mgtd::calib::testing::one_sensor());
  return fit::joint::fit_joint(table, options);
}

/// With 8000 samples ten stretches are asked: what they find is likeliest for all samples, too.
TEST(LikeliestRates, AreThoseOfAllSamplesInShortAndLongRuns) {
  for (const double seconds : {30.0, 100.0}) {
    const auto fit = fitted(walking(seconds));
    ASSERT_TRUE(fit) << fit.error().text();
    const auto found = likeliest_rates(*fit, fit::joint::WanderingRates::Constant(3, 5 * kRate_nT_per_sqrt_h),
                                       WhiteNoise::as_weighted);
    for (const double factor : {0.25, 4.0})
      EXPECT_LT(deviance_of(*fit, found), deviance_of(*fit, found * factor)) << seconds << " " << factor;
  }
}

/// The weights of the fit itself differ from axis to axis, because it took the walk of each for its noise.
TEST(LikeliestRates, OfWhiteNoiseOfAnySizeAreWithinAStepOfTheRealOnes) {
  for (const double seconds : {30.0, 60.0, 100.0}) {
    auto fit = fitted(walking(seconds));
    ASSERT_TRUE(fit) << fit.error().text();
    constexpr double kWeight_per_nT = 1;
    for (fit::joint::JointPose& pose : fit->problem.poses) pose.weight.setConstant(kWeight_per_nT);
    fit::joint::refit_nuisances(fit->problem, fit->state);
    const auto found = likeliest_rates(*fit, fit::joint::WanderingRates::Constant(3, kRate_nT_per_sqrt_h),
                                       WhiteNoise::of_any_size);
    const Residual residual(fit->problem, fit->state, 0, found);
    const double factor = std::sqrt(residual.chi2() / residual.dof());
    EXPECT_NEAR(std::log(found[0] * factor / kRate_nT_per_sqrt_h), 0, std::log(1.6)) << seconds;
    EXPECT_NEAR(factor / kWeight_per_nT, kWhite_nT, 0.1 * kWhite_nT) << seconds;
  }
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
