// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/outliers.h"

#include <gtest/gtest.h>

#include "calib/fit/joint_fit.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib {
namespace {

constexpr Eigen::Index kPose = 20;
constexpr int kOne = 4, kOther = 0;  // s2.y, s1.x

struct Scene {
  PoseTable table = testing::simulate({.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05}, 36, 121, 11);
  JointProblem problem = fit_joint(table, {})->problem;
  PoseResiduals residuals{};

  Scene() { residuals.t.setConstant(kObservations, static_cast<Eigen::Index>(table.poses.size()), 0.7F); }
};

TEST(Outliers, AreWhatStandsOutFromTheOtherPosesOfItsAxis) {
  Scene s;
  s.residuals.t(kOther, kPose) = 9;
  EXPECT_TRUE(Outliers().exclude(s.problem, s.residuals));
  EXPECT_EQ(s.problem.poses[kPose].weight[kOther], 0);
  EXPECT_GT(s.problem.poses[kPose].weight[kOne], 0);
}

/// An axis whose law is missing in the model misfits everywhere: where it does most it bends attitude and
/// field of the pose, and its neighbours with them. They are not to blame.
TEST(Outliers, AreNotTheNeighboursOfAnAxisThatMisfitsEverywhere) {
  Scene s;
  s.residuals.t.row(kOne).setConstant(12);
  s.residuals.t(kOne, kPose) = 50;
  s.residuals.t(kOther, kPose) = 9;
  s.residuals.t(kScalarRow, kPose) = 11;
  EXPECT_FALSE(Outliers().exclude(s.problem, s.residuals));
  EXPECT_GT(s.problem.poses[kPose].weight[kOther], 0);
  EXPECT_GT(s.problem.poses[kPose].f_weight, 0);
}

}  // namespace
}  // namespace mgtd::calib
