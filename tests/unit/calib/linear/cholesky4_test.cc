// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/cholesky4.h"

#include <gtest/gtest.h>

namespace mgtd::calib::linear {
namespace {

/// A pose's own unknowns are three angles in rad and a field in nT: their information differs by ten decades.
Eigen::Matrix4d of_a_pose() {
  Eigen::Matrix4d J;
  J << 5e4, 2e3, -1e3, 0.1, 3e3, 4e4, 8e3, 0.7, -2e3, 1e3, 6e4, -0.5, 7e2, -9e3, 4e3, 0.9;
  return J.transpose() * J;
}

TEST(Cholesky4, SolvesTheEquationsOfAPose) {
  const Eigen::Matrix4d H = of_a_pose();
  const Eigen::Vector4d x{1e-3, -2e-3, 3e-3, 40};
  EXPECT_TRUE(Cholesky4(H).solve(Eigen::Vector4d(H * x)).isApprox(x, 1e-12));
  EXPECT_TRUE((Cholesky4(H).solve(H)).isIdentity(1e-6));
}

TEST(Cholesky4, WhitensSoThatLengthsAreThoseByTheInverse) {
  const Eigen::Matrix4d H = of_a_pose();
  const Cholesky4 factor(H);
  Eigen::Matrix<double, 4, 3> X;
  X << 1, 2, 3, -4, 5, 6, 7, -8, 9, 1e-4, 2e-4, -3e-4;
  const Eigen::Matrix3d by_inverse = X.transpose() * factor.solve(X);
  Eigen::Matrix<double, 4, 3> white = X;
  factor.whiten(white);
  EXPECT_TRUE((white.transpose() * white).isApprox(by_inverse, 1e-12));
  EXPECT_TRUE(factor.whitened(X.col(1)).isApprox(white.col(1), 1e-15));
}

TEST(Cholesky4, ReadsTheLowerTriangleOnly) {
  const Eigen::Matrix4d H = of_a_pose(), lower = H.triangularView<Eigen::Lower>();
  const Eigen::Vector4d b{1, 2, 3, 4};
  EXPECT_EQ(Cholesky4(lower).solve(b), Cholesky4(H).solve(b));
}

TEST(Cholesky4, HoldsAnUnknownThatNothingIsKnownAbout) {
  Eigen::Matrix4d H = 4 * Eigen::Matrix4d::Identity();
  H(2, 2) = -1e-9;
  EXPECT_EQ(Cholesky4(H).solve(Eigen::Vector4d(4, 8, 12, 16)), Eigen::Vector4d(1, 2, 0, 4));
}

}  // namespace
}  // namespace mgtd::calib::linear
