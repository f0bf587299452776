// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/way_deviation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proto/units.h"

namespace mgtd::calib::effects::laws {
namespace {

PathPoint at(double t_s, double azimuth_deg, double pitch_deg, double roll_deg) {
  return {t_s, {to_rad(azimuth_deg), to_rad(pitch_deg), to_rad(roll_deg)}};
}

/// With the standard deviation of each axis over the accuracy of the table.
AngleDeviation told_of(const Eigen::Vector3d& mean_rad, const Eigen::Vector3d& sd) {
  return {mean_rad, sd.cwiseAbs2().asDiagonal()};
}

const AngleDeviation kBefore = told_of({1e-3, 2e-3, -1e-3}, {0, 0, 0}),
                     kAfter = told_of({3e-3, -2e-3, 1e-3}, {0, 0, 0});

void expect_equal(const AngleDeviation& a, const AngleDeviation& b) {
  EXPECT_TRUE(a.mean_rad.isApprox(b.mean_rad, 1e-12)) << a.mean_rad.transpose();
  EXPECT_TRUE((a.covariance - b.covariance).isZero(1e-12)) << a.covariance;
}

TEST(WayDeviation, PassesFromDwellToDwellAsEachAxisGetsOn) {
  // The azimuth has arrived when pitch and roll are halfway; it passes 180 degrees.
  const std::vector<PathPoint> way{at(0, 170, 0, 0), at(1, 180, 10, -20), at(2, -170, 20, -40),
                                   at(3, -170, 30, -60), at(4, -170, 40, -80)};
  const auto told = way_deviations(way, kBefore, kAfter);
  ASSERT_EQ(told.size(), way.size());
  expect_equal(told[0], kBefore);
  const double quarter = std::sqrt(0.25 * 0.75), half = 0.5;
  expect_equal(told[1], told_of({2e-3, 1e-3, -0.5e-3}, {half, quarter, quarter}));
  expect_equal(told[2], told_of({3e-3, 0, 0}, {0, half, half}));
  expect_equal(told[4], kAfter);
}

TEST(WayDeviation, WhatIsNotKnownAtADwellIsNotKnownOnTheWayFromIt) {
  AngleDeviation before = kBefore;
  before.covariance(0, 0) = 1;
  const std::vector<PathPoint> way{at(0, 0, 0, 0), at(1, 5, 5, 5), at(2, 20, 20, 20)};
  const auto told = way_deviations(way, before, kAfter);
  EXPECT_NEAR(told[1].covariance(0, 0), 0.75 * 0.75 + 0.25 * 0.75, 1e-12);
  EXPECT_NEAR(told[2].covariance(0, 0), 0, 1e-12);
}

/// The azimuth is at its furthest while the pitch still moves: the move ends when both stand.
TEST(WayDeviation, NothingIsKnownWhereAnAxisTurnsBack) {
  const std::vector<PathPoint> way{at(0, 0, 0, 0),    at(1, 20, 10, 10), at(2, 30, 20, 20),
                                   at(3, 30, 30, 30), at(4, 25, 30, 30), at(5, 20, 30, 30)};
  const auto told = way_deviations(way, kBefore, kAfter);
  expect_equal(told[3], {Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()});
  EXPECT_NEAR(told[2].covariance(0, 0), 1, 1e-12);
  EXPECT_NEAR(told[2].covariance(1, 1), 4.0 / 9 + 2.0 / 9, 1e-12);
  EXPECT_NEAR(told[4].covariance(0, 0), 0.25 + 0.25, 1e-12);
  EXPECT_NEAR(told[4].mean_rad[0], 1.5e-3, 1e-12);
  expect_equal(told[5], kAfter);
}

TEST(WayDeviation, OfAnAxisThatStandsItIsHalfway) {
  const std::vector<PathPoint> way{at(0, 0, 7, 0), at(1, 5, 7, 5), at(2, 20, 7, 20)};
  const auto told = way_deviations(way, kBefore, kAfter);
  EXPECT_NEAR(told[1].mean_rad[1], 0, 1e-12);
  EXPECT_NEAR(told[1].covariance(1, 1), 0.25, 1e-12);
}

/// Its steps are no larger than what an axis that stands seems to move by.
TEST(WayDeviation, ASlowAxisTurnsBackAsWell) {
  constexpr int kSteps = 300;
  constexpr double kStep_deg = 0.009;
  std::vector<PathPoint> way;
  for (int k = 0; k <= 2 * kSteps; ++k)
    way.push_back(at(k, kStep_deg * (kSteps - std::abs(k - kSteps)), 0, 0));
  const auto told = way_deviations(way, kBefore, kAfter);
  EXPECT_NEAR(told[kSteps + 1].covariance(0, 0), 1, 1e-12);
}

/// A servo that settles swings about its end by less than a turn.
TEST(WayDeviation, AServoThatSettlesDoesNotTurnBack) {
  const std::vector<PathPoint> way{at(0, 0, 0, 0), at(1, 10, 10, 10), at(2, 20.5, 20, 20), at(3, 20, 20, 20)};
  for (const AngleDeviation& told : way_deviations(way, kBefore, kAfter))
    EXPECT_LE(told.covariance.diagonal().maxCoeff(), 0.25) << told.covariance;
}

TEST(WayDeviation, OfNoWayAndOfOnePointOfIt) {
  EXPECT_TRUE(way_deviations({}, kBefore, kAfter).empty());
  const std::vector<PathPoint> way{at(0, 0, 0, 0)};
  ASSERT_EQ(way_deviations(way, kBefore, kAfter).size(), 1U);
  expect_equal(way_deviations(way, kBefore, kAfter)[0], kAfter);
}

}  // namespace
}  // namespace mgtd::calib::effects::laws
