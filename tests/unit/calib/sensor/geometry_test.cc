// SPDX-License-Identifier: Apache-2.0
#include "calib/sensor/geometry.h"

#include <gtest/gtest.h>

#include <utility>

namespace mgtd::calib::sensor {
namespace {

using Places = PerSensor<Eigen::Vector3d>;

Places cross(double h) { return {{h, 0, 0}, {0, h, 0}, {-h, 0, 0}, {0, -h, 0}}; }

TEST(Geometry, OnlyTheExactCrossInItsOrderIsTheCross) {
  EXPECT_EQ(Geometry(cross(0.25)).cross_baseline_m(), 0.5);
  EXPECT_EQ(Geometry(0.5), Geometry(cross(0.25)));
  Places other = cross(0.2);
  std::swap(other[0], other[2]);
  EXPECT_FALSE(Geometry(other).cross_baseline_m());
  other = cross(0.2);
  other[3].z() = 1e-6;
  EXPECT_FALSE(Geometry(other).cross_baseline_m());
  constexpr double h = 0.2;
  EXPECT_FALSE(Geometry(Places{{h, h, h}, {h, -h, -h}, {-h, h, -h}, {-h, -h, h}}).cross_baseline_m());
  EXPECT_FALSE(Geometry(Places{{0.2, 0, 0}}).cross_baseline_m());
}

}  // namespace
}  // namespace mgtd::calib::sensor
