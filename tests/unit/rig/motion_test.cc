// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

constexpr std::array kAll{MotionKind::hand, MotionKind::flight, MotionKind::level, MotionKind::one_axis};

Recording script(MotionKind kind, double duration_s = 300) {
  return {.motion = kind, .duration_s = duration_s, .rest_s = 5};
}

double angle_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a * b.transpose()).angle() / kDeg;
}

TEST(Motion, EveryNameIsReadBack) {
  for (const MotionKind kind : kAll) {
    MotionKind read = kind == MotionKind::hand ? MotionKind::level : MotionKind::hand;
    EXPECT_TRUE(read_motion(motion_name(kind), read));
    EXPECT_EQ(read, kind);
  }
  MotionKind kind{};
  EXPECT_FALSE(read_motion("swim", kind));
}

TEST(Motion, RestsAndMovesSmoothlyBetween) {
  for (const MotionKind kind : kAll) {
    const Motion motion(script(kind), 1);
    EXPECT_LT(angle_deg(motion.attitude(0), motion.attitude(5)), 1e-5) << motion_name(kind);
    EXPECT_LT(angle_deg(motion.attitude(295), motion.attitude(300)), 1e-5) << motion_name(kind);
    constexpr double kStep_s = 0.1;
    double fastest_deg_per_s = 0, last_deg_per_s = 0, jerk_deg_per_s2 = 0;
    for (int k = 0; k < 2999; ++k) {
      const Eigen::Matrix3d R = motion.attitude(k * kStep_s);
      EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      const double rate = angle_deg(motion.attitude((k + 1) * kStep_s), R) / kStep_s;
      fastest_deg_per_s = std::max(fastest_deg_per_s, rate);
      jerk_deg_per_s2 = std::max(jerk_deg_per_s2, std::abs(rate - last_deg_per_s) / kStep_s);
      last_deg_per_s = rate;
    }
    EXPECT_GT(fastest_deg_per_s, 5) << motion_name(kind);
    EXPECT_LT(fastest_deg_per_s, 250) << motion_name(kind);
    EXPECT_LT(jerk_deg_per_s2, 10 / kDeg) << motion_name(kind);
  }
}

TEST(Motion, IsTheSameForTheSameSeedAndAnotherForAnother) {
  for (const MotionKind kind : kAll) {
    const Motion a(script(kind), 3), b(script(kind), 3), other(script(kind), 4);
    EXPECT_EQ(a.attitude(77.7), b.attitude(77.7)) << motion_name(kind);
    EXPECT_GT(angle_deg(a.attitude(77.7), other.attitude(77.7)), 0.1) << motion_name(kind);
  }
}

/// By hand the field comes from everywhere within some minutes: of 48 equal patches of the sphere (six of
/// equal height, eight round about) none is left out.
TEST(Motion, AHandCoversTheSphere) {
  const Motion motion(script(MotionKind::hand, 600), 1);
  std::set<int> seen;
  for (int k = 0; k < 6000; ++k) {
    const Eigen::Vector3d b = motion.attitude(0.1 * k).col(2);
    const int height = std::min(5, static_cast<int>(3 * (b[2] + 1)));
    const int around = std::min(7, static_cast<int>(8 * (std::atan2(b[1], b[0]) / (360 * kDeg) + 0.5)));
    seen.insert(8 * height + around);
  }
  EXPECT_EQ(seen.size(), 48U);
}

TEST(Motion, LevelIsLevelAndGoesRound) {
  const Motion motion(script(MotionKind::level), 1);
  double least = 0, most = 0;
  for (int k = 0; k < 3000; ++k) {
    const Eigen::Matrix3d R = motion.attitude(0.1 * k);
    EXPECT_NEAR(R(2, 2), 1, 1e-14);
    least = std::min(least, R(0, 0));
    most = std::max(most, R(0, 0));
  }
  EXPECT_LT(least, -0.9);
  EXPECT_GT(most, 0.9);
}

/// A field fixed to the site stays on a cone about the axis.
TEST(Motion, AboutOneAxisAFieldStaysOnACone) {
  const Motion motion(script(MotionKind::one_axis), 1);
  const Eigen::Matrix3d turned = motion.attitude(12.5) * motion.attitude(10).transpose();  // a quarter
  const Eigen::Vector3d axis = Eigen::AngleAxisd(turned).axis();
  const Eigen::Vector3d B = Eigen::Vector3d(1, -2, 3).normalized();
  const double cone = axis.dot(motion.attitude(0) * B);
  Eigen::Vector3d sum(0, 0, 0);
  for (int k = 0; k < 3000; ++k) {
    const Eigen::Vector3d b = motion.attitude(0.1 * k) * B;
    EXPECT_NEAR(axis.dot(b), cone, 1e-9);
    if (k >= 500 && k < 2500) sum += b;
  }
  EXPECT_LT((sum / 2000 - cone * axis).norm(), 0.01);  // twenty whole turns
}

/// Turns are banked, legs are flown on many headings, and the array is nearly upright all the time.
TEST(Motion, AFlightBanksAndSwings) {
  const Motion motion(script(MotionKind::flight, 900), 1);
  double roll_deg = 0, pitch_deg = 0;
  std::set<int> headings;
  for (int k = 0; k < 9000; ++k) {
    const Eigen::Matrix3d R = motion.attitude(0.1 * k);
    const Eigen::Vector3d down = R.col(2);  // R = Rx(roll) Ry(pitch) Rz(heading)
    roll_deg = std::max(roll_deg, std::abs(std::atan2(down[1], down[2]) / kDeg));
    pitch_deg = std::max(pitch_deg, std::abs(std::asin(R(0, 2)) / kDeg));
    headings.insert(static_cast<int>(std::floor(std::atan2(R(0, 1), R(0, 0)) / (30 * kDeg))));
  }
  EXPECT_GT(roll_deg, 25);
  EXPECT_LT(roll_deg, 40);
  EXPECT_GT(pitch_deg, 4);
  EXPECT_LT(pitch_deg, 8);
  EXPECT_EQ(headings.size(), 12U);
}

}  // namespace
}  // namespace mgtd::rig
