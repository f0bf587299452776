// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mgtd::calib::linear {
namespace {

/// Eigenvalues 1, 3 and 9; above the diagonal stands what must not be read.
const Eigen::Matrix3d kLower{{2, 99, 99}, {1, 2, 99}, {0, 0, 9}};

TEST(SymmetricEigen, AscendingAndOrthonormalFromTheLowerTriangle) {
  const SymmetricEigen eigen = symmetric_eigen(kLower);
  const Eigen::VectorXd values{{1, 3, 9}};
  EXPECT_TRUE(eigen.values.isApprox(values, 1e-14)) << eigen.values;
  EXPECT_TRUE(symmetric_eigenvalues(kLower).isApprox(values, 1e-14));
  EXPECT_NEAR(std::abs(eigen.vectors(0, 1)), std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(eigen.vectors(0, 1), eigen.vectors(1, 1), 1e-14);  // (1, 1, 0) belongs to 3
  EXPECT_NEAR(std::abs(eigen.vectors(2, 2)), 1, 1e-14);
}

TEST(PrincipalAxes, AreTheEigenvectorsOfAScatter) {
  const PrincipalAxes axes = principal_axes(kLower);
  EXPECT_TRUE(axes.values.isApprox(Eigen::Vector3d(1, 3, 9), 1e-14)) << axes.values;
  EXPECT_NEAR(axes.vectors(0, 0), -axes.vectors(1, 0), 1e-14);  // (1, -1, 0) belongs to 1
  EXPECT_NEAR(std::abs(axes.vectors(2, 2)), 1, 1e-14);
}

}  // namespace
}  // namespace mgtd::calib::linear
