// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/dwell_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace mgtd::calib::fit {
namespace {

constexpr double kDwell_s = 8, kGap_s = 20;

/// Sixty poses beside which the vector reads (20 000, 0, 45 000 + along) nT.
PoseTable run(const std::function<double(int)>& along_nT) {
  PoseTable out;
  for (int k = 0; k < 60; ++k) {
    Pose pose;
    pose.t_s = kGap_s * k;
    pose.dwell_s = kDwell_s;
    pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = 0.1 * k;
    pose.ref_nT = Eigen::Vector3d(20'000, 0, 45'000 + along_nT(k));
    pose.ref_sd_nT = 0;
    out.poses.push_back(pose);
  }
  return out;
}

double motion_nT(const PoseTable& table) { return dwell_motion(table).value().component_nT; }

/// Of a component, where one of the three moves by so much from pose to pose.
double of_moves(double mean_square_nT2) { return std::sqrt(mean_square_nT2 / 3 / 12) * kDwell_s / kGap_s; }

TEST(DwellMotion, IsTheRateTimesTheDwell) {
  EXPECT_NEAR(motion_nT(run([](int k) { return 6.0 * k; })), of_moves(36), 1e-9);
}

TEST(DwellMotion, AGrossReadingDoesNotCount) {
  for (const int gross : {0, 1, 30, 58, 59}) {
    const PoseTable table = run([=](int k) { return 6.0 * k + (k == gross ? 900.0 : 0.0); });
    EXPECT_NEAR(motion_nT(table), of_moves(36), 1e-9) << gross;
  }
}

/// A burst of a storm in a quiet run is what the field did.
TEST(DwellMotion, ABurstCounts) {
  const PoseTable table = run([](int k) { return 0.1 * k + (k >= 40 ? 50.0 * std::min(k - 39, 5) : 0.0); });
  EXPECT_NEAR(motion_nT(table), of_moves((54 * 0.01 + 5 * 50.1 * 50.1) / 59), 1e-6);
}

TEST(DwellMotion, AFieldAtRestDoesNotMove) {
  EXPECT_EQ(motion_nT(run([](int) { return 0.0; })), 0);
}

TEST(DwellMotion, TooFewPosesTellNothing) {
  PoseTable table = run([](int k) { return 6.0 * k; });
  table.poses.resize(12);
  EXPECT_FALSE(dwell_motion(table).has_value());
}

}  // namespace
}  // namespace mgtd::calib::fit
