// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

#include "proto/tensor.h"

namespace mgtd {
namespace {

Gradient gradient_of(const Eigen::Matrix3d& G) {
  return {.xx = G(0, 0), .yy = G(1, 1), .zz = G(2, 2), .xy = G(0, 1), .xz = G(0, 2), .yz = G(1, 2)};
}

/// Below a dipole that points down the tensor is g diag(1, 1, -2).
TEST(TensorInvariants, OfTheTensorBelowADipole) {
  const auto found = invariants({.xx = 5, .yy = 5, .zz = -10});
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->I1_nT2_per_m2, -75);
  EXPECT_DOUBLE_EQ(found->I2_nT3_per_m3, -250);
  EXPECT_DOUBLE_EQ(found->contraction_nT_per_m, std::sqrt(150.0));
}

TEST(TensorInvariants, StayWhenTheFrameIsTurned) {
  Eigen::Matrix3d G;
  G << 12, -7, 3, -7, 5, 11, 3, 11, -17;
  const auto before = invariants(gradient_of(G));
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, -2, 0.5).normalized()).matrix();
  const auto after = invariants(gradient_of(R * G * R.transpose()));
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(after->I1_nT2_per_m2, before->I1_nT2_per_m2, 1e-9);
  EXPECT_NEAR(after->I2_nT3_per_m3, before->I2_nT3_per_m3, 1e-9);
  EXPECT_NEAR(after->contraction_nT_per_m, before->contraction_nT_per_m, 1e-12);
  EXPECT_NEAR(before->contraction_nT_per_m, std::sqrt(-2 * before->I1_nT2_per_m2), 1e-12);
}

TEST(TensorInvariants, NeedEveryComponent) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < 6; ++i) {
    std::array<double, 6> g{1, 2, -3, 4, 5, 6};
    g[i] = kNone;
    EXPECT_FALSE(invariants({g[0], g[1], g[2], g[3], g[4], g[5]})) << i;
  }
}

}  // namespace
}  // namespace mgtd
