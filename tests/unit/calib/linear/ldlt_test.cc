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

}  // namespace
}  // namespace mgtd::calib::linear
