// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/likeliest_rates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

/// With 8000 samples ten stretches are asked: what they find is likeliest for all samples, too.
TEST(LikeliestRates, AreThoseOfAllSamplesInShortAndLongRuns) {
  for (const double seconds : {30.0, 100.0}) {
    fit::joint::JointOptions options;
    options.geometry = mgtd::calib::testing::geometry_of(mgtd::calib::testing::one_sensor());
    const PoseTable table = walking(seconds);
    const auto fit = fit::joint::fit_joint(table, options);
    ASSERT_TRUE(fit) << fit.error().text();
    const auto found = likeliest_rates(*fit, fit::joint::WanderingRates::Constant(3, 5 * kRate_nT_per_sqrt_h),
                                       WhiteNoise::as_weighted);
    for (const double factor : {0.25, 4.0})
      EXPECT_LT(deviance_of(*fit, found), deviance_of(*fit, found * factor)) << seconds << " " << factor;
  }
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
