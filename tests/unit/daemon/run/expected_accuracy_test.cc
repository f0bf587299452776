// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/expected_accuracy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "calib/fit/joint/tensor_uncertainty.h"

namespace mgtd::daemon::run {
namespace {

constexpr double kPi = std::numbers::pi;

plan::RunPlan plan_of(int random) {
  return *plan::make_plan({.step_deg = 20, .random = random, .revisits = 4, .dwell_short_s = 4},
                          {.azimuth = {-kPi, kPi}, .pitch = {-kPi / 2, kPi / 2}, .roll = {-kPi, kPi}});
}

/// At zero angles, in a field of 50 000 nT that dips by 60 degrees.
Pose first_pose(double sd_nT) {
  Pose pose;
  pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = 0;
  pose.n = 100;
  for (std::size_t i = 0; i < pose.y_nT.size(); ++i) {
    pose.y_nT[i] = 50'000 * Eigen::Vector3d(std::cos(kPi / 3), 0, std::sin(kPi / 3));
    for (auto& sd : pose.sd_nT[i]) sd = sd_nT;
  }
  return pose;
}

config::Config with_scalar() {
  config::Config config;
  config.scalar.emplace();
  return config;
}

TEST(ExpectedAccuracy, ShrinksToThatOfTheWholePlan) {
  const auto request = planned_design(with_scalar(), plan_of(60), first_pose(2));
  ASSERT_TRUE(request);
  EXPECT_NEAR(request->pose_noise_nT, 0.2, 1e-12);
  EXPECT_NEAR(request->f_nT, 50'000, 1e-6);
  EXPECT_NEAR(to_deg(request->inclination_rad), 60, 1e-9);
  const auto expected = expected_accuracy(*request, {});
  ASSERT_GE(expected.size(), 3u);
  EXPECT_GT(expected.front().poses, 18) << "a turn about one axis determines no calibration";
  EXPECT_EQ(expected.back().poses, 78);
  for (std::size_t i = 1; i < expected.size(); ++i)
    EXPECT_LT(expected[i].worst_nT_per_m, expected[i - 1].worst_nT_per_m) << i;
  EXPECT_EQ(
      expected.back().worst_nT_per_m,
      calib::fit::joint::worst_component(calib::design::evaluate_design(*request)->tensor_sd_nT_per_m).value);
}

TEST(ExpectedAccuracy, LongerDwellsAreLessNoisy) {
  plan::RunPlan plan = plan_of(60);
  for (plan::PlannedPose& pose : plan.poses) pose.dwell_s = 16;
  Pose first = first_pose(2);
  first.dwell_s = 4;
  EXPECT_NEAR(planned_design(with_scalar(), plan, first)->pose_noise_nT, 0.1, 1e-12);
}

TEST(ExpectedAccuracy, NeedsANoise) {
  EXPECT_FALSE(planned_design(with_scalar(), plan_of(20), first_pose(0)));
  Pose without = first_pose(1);
  without.n.reset();
  EXPECT_FALSE(planned_design(with_scalar(), plan_of(20), without));
}

TEST(ExpectedAccuracy, EndsWhenItIsToldTo) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(expected_accuracy(*planned_design(with_scalar(), plan_of(20), first_pose(1)), stop.get_token())
                  .empty());
}

}  // namespace
}  // namespace mgtd::daemon::run
