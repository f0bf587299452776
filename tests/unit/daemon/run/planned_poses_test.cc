// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/planned_poses.h"

#include <gtest/gtest.h>

#include "daemon/plan/run_plan.h"
#include "proto/units.h"
#include "tests/support/checkout.h"

namespace mgtd::daemon::run {
namespace {

TEST(PlannedPoses, AreThoseOfTheRunWithTheirTimes) {
  const auto poses = planned_poses(config::Config{});
  ASSERT_TRUE(poses) << poses.error().text();
  ASSERT_EQ(poses->poses.size(), 157U);
  const drivers::TableLimits anywhere{{-3.2, 3.2}, {-1.6, 1.6}, {-3.2, 3.2}};
  const auto plan = plan::make_plan({}, anywhere);
  ASSERT_TRUE(plan);
  double before = 0;
  for (std::size_t k = 0; k < plan->poses.size(); ++k) {
    const Pose& pose = poses->poses[k];
    EXPECT_EQ(pose.number, plan->poses[k].number);
    EXPECT_EQ(pose.set, plan->poses[k].set);
    EXPECT_EQ(*pose.dwell_s, plan->poses[k].dwell_s);
    EXPECT_GT(*pose.t_s, before);
    before = *pose.t_s;
  }
  EXPECT_GT(before, 1000);  // a run takes its time
}

TEST(PlannedPoses, ARunThatCannotBePlannedIsRefused) {
  config::Config config;
  config.run.step_deg = 7;
  EXPECT_FALSE(planned_poses(config));
}

TEST(PlannedPoses, OnlyAttitudesWithinTheLimitsAreProposed) {
  auto config = config::load_config(mgtd::testing::source_path("systemd/mgtd.toml"));
  ASSERT_TRUE(config);
  const auto left =
      reachable(*config, {{to_rad(270), 0, 0}, {0, 0, to_rad(180)}, {to_rad(45), to_rad(-90), to_rad(90)}});
  ASSERT_EQ(left.size(), 2U);  // roll ends at 90
  EXPECT_NEAR(left[0].azimuth_rad, to_rad(-90), 1e-12);
}

}  // namespace
}  // namespace mgtd::daemon::run
