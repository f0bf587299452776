// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "tests/rig/rotations.h"
#include "tests/scenario/virtual_daemon.h"

namespace mgtd::test {

/// Nothing of the trouble is in the data: every stored pose is of a table at rest where it says it was (its
/// accuracy is 0.1 degree per axis), and every sensor, put right by the truth, reads the site's field.
inline void expect_clean(VirtualDaemon& daemon) {
  const rig::Scenario& scenario = daemon.rig.world().scenario();
  const double inclination_rad = to_rad(scenario.inclination_deg),
               declination_rad = to_rad(scenario.declination_deg);
  const Eigen::Vector3d b_S(std::cos(inclination_rad) * std::cos(declination_rad),
                            std::cos(inclination_rad) * std::sin(declination_rad), std::sin(inclination_rad));
  for (const Pose& pose : daemon.poses.poses) {
    SCOPED_TRACE(fmt::format("pose {}", pose.number));
    EXPECT_NEAR(pose.f_nT.value_or(0), scenario.f_nT, 0.1);
    const auto angles = pose.angles();
    ASSERT_TRUE(angles);
    const Eigen::Vector3d n_P = rig::about_z(to_deg(angles->azimuth_rad)) *
                                rig::about_y(to_deg(angles->pitch_rad)) *
                                rig::about_x(to_deg(angles->roll_rad)) * b_S;
    for (std::size_t i = 0; i < kSensors; ++i) {
      const rig::SensorTruth& truth = scenario.truth[i];
      const Eigen::Vector3d b_P_nT = truth.matrix().inverse() * (pose.y_nT[i] - truth.offset_nT);
      EXPECT_NEAR(b_P_nT.norm(), scenario.f_nT, 0.5);  // 0.3 nT / sqrt(100), times the 15 axes' worst of many
      EXPECT_LT(to_deg(b_P_nT.normalized().cross(n_P).norm()), 0.7);
      // Of a sample 0.3 nT; stated larger, up to twice, where interpolation made successive epochs alike. A
      // table not yet at rest adds several nT.
      for (const auto& sd_nT : pose.sd_nT[i]) EXPECT_LT(sd_nT.value_or(99), 0.65);
    }
  }
}

}  // namespace mgtd::test
