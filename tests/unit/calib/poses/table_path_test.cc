// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/table_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mgtd::calib::poses {
namespace {

constexpr double kVelocity_deg_per_s = 20, kAcceleration_deg_per_s2 = 40, kReadings_s = 0.1;

/// A move of one axis by `way_deg` that accelerates, turns at constant velocity and brakes.
double moved_deg(double way_deg, double t_s) {
  const double ramp_s = kVelocity_deg_per_s / kAcceleration_deg_per_s2;
  const double end_s = way_deg / kVelocity_deg_per_s + ramp_s;
  t_s = std::clamp(t_s, 0.0, end_s);
  if (t_s < ramp_s) return kAcceleration_deg_per_s2 * t_s * t_s / 2;
  if (t_s > end_s - ramp_s) return way_deg - kAcceleration_deg_per_s2 * std::pow(end_s - t_s, 2) / 2;
  return kVelocity_deg_per_s * (t_s - ramp_s / 2);
}

TableAngles angles_at(double t_s) {
  constexpr double kRad = std::numbers::pi / 180;
  return {kRad * moved_deg(117, t_s), -kRad * moved_deg(43, t_s), kRad * moved_deg(61, t_s)};
}

std::vector<PathPoint> path_until(double end_s, double azimuth_from_rad = 0) {
  std::vector<PathPoint> out;
  for (int k = 0; kReadings_s * k <= end_s; ++k) {
    TableAngles angles = angles_at(kReadings_s * k);
    angles.azimuth_rad = std::remainder(angles.azimuth_rad + azimuth_from_rad, 2 * std::numbers::pi);
    out.push_back({kReadings_s * k, angles});
  }
  return out;
}

double furthest_deg(const TableAngles& a, const TableAngles& b) {
  const double azimuth_rad = std::remainder(a.azimuth_rad - b.azimuth_rad, 2 * std::numbers::pi);
  return std::max({std::abs(azimuth_rad), std::abs(a.pitch_rad - b.pitch_rad),
                   std::abs(a.roll_rad - b.roll_rad)}) *
         180 / std::numbers::pi;
}

/// Axes that stop one after the other, none of them at the moment of a reading.
TEST(TablePath, FollowsAMoveBetweenItsReadingsAsCloselyAsTheHeaderSays) {
  for (const double from_rad : {0.0, 2.5}) {  // the second one passes 180 degrees
    const TablePath path(path_until(6.5, from_rad));
    double worst_deg = 0;
    for (double t_s = 0; t_s < 6.5; t_s += 0.003) {
      TableAngles expected = angles_at(t_s);
      expected.azimuth_rad += from_rad;
      const auto found = path.at(t_s);
      ASSERT_TRUE(found) << t_s;
      worst_deg = std::max(worst_deg, furthest_deg(*found, expected));
    }
    EXPECT_LT(worst_deg, kAcceleration_deg_per_s2 * kReadings_s * kReadings_s / 8);
  }
}

TEST(TablePath, KnowsNothingOutsideNorAmongFewReadingsNorInAJump) {
  const std::vector<PathPoint> points = path_until(6.5);
  EXPECT_FALSE(TablePath(points).at(-0.01));
  EXPECT_FALSE(TablePath(points).at(6.6));
  EXPECT_FALSE(TablePath(std::span(points).first(3)).at(0.1));
  EXPECT_FALSE(TablePath({}).at(0));
  std::vector<PathPoint> jump = points;
  for (std::size_t k = 30; k < jump.size(); ++k) jump[k].angles.roll_rad += 1.5;
  const TablePath path(jump);
  EXPECT_TRUE(path.at(2.85));
  EXPECT_FALSE(path.at(2.95));
  ASSERT_TRUE(path.at(3.05));
  EXPECT_NEAR(path.at(3.05)->roll_rad, angles_at(3.05).roll_rad + 1.5, 1e-3);
}

TEST(TablePath, TakesTheFirstOfReadingsOfOneMoment) {
  std::vector<PathPoint> points = path_until(6.5);
  points.insert(points.begin() + 21, {points[20].t_s, {}});
  ASSERT_TRUE(TablePath(points).at(2.05));
  EXPECT_LT(furthest_deg(*TablePath(points).at(2.05), angles_at(2.05)), 0.03);
}

}  // namespace
}  // namespace mgtd::calib::poses
