// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/accuracy_so_far.h"

#include <gtest/gtest.h>

#include "calib/fit/method_choice/fit.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

TEST(AccuracySoFar, GrowsWithThePosesAndEndsWhereTheWholeFitDoes) {
  const PoseTable whole = testing::simulate({.table_sd_rad = to_rad(0.1)}, 36, 121, 3);
  PoseTable table;
  std::optional<AccuracySoFar> last;
  double with_40 = 0, offset_with_40_nT = 0;
  for (const Pose& pose : whole.poses) {
    table.poses.push_back(pose);
    auto known = accuracy_so_far(table, {}, last ? &last->state : nullptr);
    // A level turn does not tell: the random poses do.
    EXPECT_EQ(known.has_value(), table.poses.size() > 36) << table.poses.size();
    if (!known) continue;
    last = *std::move(known);
    EXPECT_EQ(last->poses, static_cast<int>(table.poses.size()));
    if (table.poses.size() != 40) continue;
    with_40 = last->worst_nT_per_m();
    offset_with_40_nT = last->fit.offset_sd_nT;
  }
  const auto report = method_choice::fit(whole, {});
  ASSERT_TRUE(report && last);
  EXPECT_NEAR(last->worst_nT_per_m(), report->tensor_sd_nT_per_m.zz, 0.02 * report->tensor_sd_nT_per_m.zz);
  EXPECT_GT(with_40, 2 * last->worst_nT_per_m());
  EXPECT_NEAR(last->fit.residual_nT, report->residual_nT, 0.02 * report->residual_nT);
  const FitSoFar whole_fit =
      fit_so_far(report->calibration.covariance, report->calibration.sensors.size(), 0);
  EXPECT_NEAR(last->fit.offset_sd_nT, whole_fit.offset_sd_nT, 0.02 * whole_fit.offset_sd_nT);
  EXPECT_NEAR(last->fit.scale_sd, whole_fit.scale_sd, 0.02 * whole_fit.scale_sd);
  EXPECT_NEAR(last->fit.angle_sd_rad, whole_fit.angle_sd_rad, 0.02 * whole_fit.angle_sd_rad);
  EXPECT_GT(offset_with_40_nT, last->fit.offset_sd_nT);
}

/// Offsets, scales and angles of two sensors, each with its largest standard deviation elsewhere.
TEST(AccuracySoFar, TheLargestOfEachKindCounts) {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(26, 26) * 1e-12;
  covariance(sensor::ix, sensor::ix) = 4;
  covariance(sensor::kSensorParameters + sensor::cz, sensor::kSensorParameters + sensor::cz) = 9e-8;
  covariance(sensor::kSensorParameters + sensor::gamma, sensor::kSensorParameters + sensor::gamma) = 25e-8;
  covariance(25, 25) = 100;  // of no sensor
  const FitSoFar fit = fit_so_far(covariance, 2, 0.5);
  EXPECT_DOUBLE_EQ(fit.residual_nT, 0.5);
  EXPECT_DOUBLE_EQ(fit.offset_sd_nT, 2);
  EXPECT_DOUBLE_EQ(fit.scale_sd, 3e-4);
  EXPECT_DOUBLE_EQ(fit.angle_sd_rad, 5e-4);
  ASSERT_EQ(fit.parameter_sd.size(), 24U) << "those of the sensors";
  EXPECT_DOUBLE_EQ(fit.parameter_sd[sensor::ix], 2);
  EXPECT_DOUBLE_EQ(fit.parameter_sd[sensor::kSensorParameters + sensor::cz], 3e-4);
  EXPECT_DOUBLE_EQ(fit.parameter_sd[sensor::alpha], 1e-6);
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
