// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/ldlt.h"

#include <gtest/gtest.h>

namespace mgtd::calib::linear {
namespace {

TEST(SolveByLdlt, OfARegularMatrixIsTheSolution) {
  const Eigen::MatrixXd A{{4, 2}, {2, 10}};
  const Eigen::VectorXd b{{8, 22}}, x{{1, 2}};
  EXPECT_TRUE(solve_by_ldlt(A, b).isApprox(x, 1e-14)) << solve_by_ldlt(A, b);
  EXPECT_TRUE(solve_by_ldlt(A, Eigen::MatrixXd(A)).isIdentity(1e-14));
}

TEST(SolveByLdlt, ADirectionWithoutAPivotGetsNothing) {
  const Eigen::MatrixXd A{{0, 0, 0}, {0, 4, 4}, {0, 4, 4}};
  const Eigen::VectorXd b{{0, 8, 8}}, x = solve_by_ldlt(A, b);
  EXPECT_TRUE(x.allFinite()) << x;
  EXPECT_EQ(x[0], 0);
  EXPECT_TRUE((A * x).isApprox(b, 1e-14)) << x;
}

/// Nanotesla beside radians: the same unknowns in units 1e9 apart.
TEST(SolveByScaledLdlt, IsTheSolutionWhateverTheUnits) {
  const Eigen::MatrixXd A{{4, 2e-9}, {2e-9, 10e-18}};
  const Eigen::VectorXd b{{8, 22e-9}}, x{{1, 2e9}};
  EXPECT_TRUE(solve_by_scaled_ldlt(A, b).isApprox(x, 1e-14)) << solve_by_scaled_ldlt(A, b);
  EXPECT_TRUE(solve_by_scaled_ldlt(A, Eigen::MatrixXd(b)).isApprox(x, 1e-14));
}

TEST(SolveByScaledLdlt, ADirectionThatNothingDeterminesGetsNothing) {
  const Eigen::MatrixXd A{{0, 0}, {0, 4}};
  const Eigen::VectorXd b{{0, 8}}, x{{0, 2}};
  EXPECT_EQ(solve_by_scaled_ldlt(A, b), x);
}

TEST(SolveByScaledLdlt, ARidgeHoldsWhatTwoUnknownsShareHalfAndHalf) {
  const Eigen::MatrixXd A{{4, 4}, {4, 4}};
  const Eigen::MatrixXd x = solve_by_scaled_ldlt(A, Eigen::MatrixXd{{8}, {8}}, 1e-9);
  EXPECT_NEAR(x(0), 1, 1e-6);
  EXPECT_NEAR(x(1), 1, 1e-6);
}

}  // namespace
}  // namespace mgtd::calib::linear
