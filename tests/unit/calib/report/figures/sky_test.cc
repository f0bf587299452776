// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/calib/report/figures/examples.h"

namespace mgtd::calib::report::figures {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Sky, CornersOfTheMapAreWhereTheyBelong) {
  EXPECT_NEAR(sky_point(kPi, 0).x, kSkyHalfWidth, 1e-12);
  EXPECT_NEAR(sky_point(0, kPi / 2).y, kSkyHalfHeight, 1e-12);
  EXPECT_NEAR(sky_point(2, kPi / 2).x, 0, 1e-6);
  EXPECT_NEAR(sky_point(Eigen::Vector3d(0, 5, 0)).x, kSkyHalfWidth / 2, 1e-12);
  EXPECT_TRUE(std::isnan(sky_point(Eigen::Vector3d::Zero()).x));
}

/// y of the parallel over that of the pole.
TEST(Sky, AgreesWithThePublishedTable) {
  EXPECT_NEAR(sky_point(0, 30 * kPi / 180).y / kSkyHalfHeight, 0.40397, 5e-6);
  EXPECT_NEAR(sky_point(0, 60 * kPi / 180).y / kSkyHalfHeight, 0.76239, 5e-6);
}

/// A small quadrangle of the sphere has the area (difference of longitudes) x (difference of sines).
TEST(Sky, EqualAreasStayEqual) {
  for (double latitude = -1.5; latitude < 1.5; latitude += 0.21) {
    for (double longitude = -3.1; longitude < 3.1; longitude += 0.37) {
      constexpr double kStep = 1e-4;
      const SkyPoint at = sky_point(longitude, latitude), east = sky_point(longitude + kStep, latitude),
                     north = sky_point(longitude, latitude + kStep);
      const double on_paper = (east.x - at.x) * (north.y - at.y) - (east.y - at.y) * (north.x - at.x);
      const double on_sphere = kStep * (std::sin(latitude + kStep) - std::sin(latitude));
      EXPECT_NEAR(on_paper / on_sphere, 1, 2e-3) << latitude << " " << longitude;
    }
  }
}

TEST(Sky, CellsHaveOneAreaAndHoldTheirDirections) {
  const auto cells = sky_cells(12, 24);
  for (const SkyCell& c : cells)
    EXPECT_NEAR((c.to_longitude_rad - c.from_longitude_rad) *
                    (std::sin(c.to_latitude_rad) - std::sin(c.from_latitude_rad)),
                4 * kPi / static_cast<double>(cells.size()), 1e-9);
  for (std::size_t i = 0; i < 500; ++i) {
    const Eigen::Vector3d d = testing::direction_at(i, 500);
    const SkyCell& c = cells[sky_cell_of(d, 12, 24)];
    EXPECT_LE(c.from_latitude_rad, std::asin(d.z()) + 1e-9);
    EXPECT_GE(c.to_latitude_rad, std::asin(d.z()) - 1e-9);
    EXPECT_LE(c.from_longitude_rad, std::atan2(d.y(), d.x()) + 1e-9);
    EXPECT_GE(c.to_longitude_rad, std::atan2(d.y(), d.x()) - 1e-9);
  }
}

TEST(Sky, TheLargestHoleIsWhereNothingWasMeasured) {
  const Eigen::Vector3d missing = Eigen::Vector3d(1, -2, 0.5).normalized();
  std::vector<Eigen::Vector3d> measured;
  for (std::size_t i = 0; i < 2000; ++i) {
    const Eigen::Vector3d d = testing::direction_at(i, 2000);
    if (std::acos(d.dot(missing)) > 0.7) measured.push_back(d);
  }
  const LargestHole hole = largest_hole(measured);
  EXPECT_NEAR(hole.radius_rad, 0.7, 0.05);
  EXPECT_LT(std::acos(hole.centre.dot(missing)), 0.08);
  for (const Eigen::Vector3d& d : circle_around(hole.centre, hole.radius_rad, 12))
    EXPECT_NEAR(std::acos(d.dot(hole.centre)), hole.radius_rad, 1e-9);
}

TEST(Sky, TheHoleShrinksFromDirectionToDirection) {
  HoleSearch search;
  EXPECT_FALSE(search.largest());
  search.add({0, 0, 3});
  EXPECT_NEAR(search.largest()->radius_rad, kPi, 0.2) << "the other pole";
  search.add({0, 0, -1});
  EXPECT_NEAR(search.largest()->radius_rad, kPi / 2, 0.03) << "the equator";
  search.add({1, 0, 0});
  EXPECT_LT(search.largest()->centre.x(), 0);
}

}  // namespace
}  // namespace mgtd::calib::report::figures
