// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/score.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace mgtd::calib::criticism::tests {
namespace {

/// Columns in general directions, but the last is the first one and a share `apart` of another.
Signature signature(Eigen::Index rows, Eigen::Index columns, double apart, double absorbed = kAbsorbed) {
  Eigen::MatrixXd z = Eigen::MatrixXd::NullaryExpr(rows, columns, [](Eigen::Index i, Eigen::Index j) {
    return std::sin(1.3 * static_cast<double>(i * (j + 1)) + 0.4 * static_cast<double>(j));
  });
  z.col(columns - 1) = z.col(0) + apart * z.col(columns - 1);
  return {z, Eigen::VectorXd::LinSpaced(rows, -1, 2), absorbed};
}

Hypothesis everything(Eigen::Index columns) {
  return {.combine = Eigen::MatrixXd::Identity(columns, columns), .names = {}};
}

TEST(OneStep, CoefficientsAreThoseOfLeastSquares) {
  const Signature s = signature(60, 5, 0.1);
  const OneStep step = one_step(s, everything(5));
  EXPECT_TRUE(step.value.isApprox(s.gram().inverse() * s.by_residual(), 1e-8));
  EXPECT_TRUE(step.covariance.isApprox(s.gram().inverse(), 1e-8));
}

TEST(OneStep, CombinedColumnsAreSummed) {
  const Signature s = signature(60, 4, 1);
  Hypothesis h;
  h.combine = Eigen::MatrixXd{{1, 0}, {1, 0}, {0, 0}, {0, 1}};
  const OneStep step = one_step(s, h);
  const Eigen::MatrixXd z = s.times(h.combine);
  const Eigen::VectorXd expected = (z.transpose() * z).inverse() * (h.combine.transpose() * s.by_residual());
  EXPECT_TRUE(step.value.isApprox(expected, 1e-10));
  EXPECT_EQ(step.basis.rows(), 4);
  EXPECT_TRUE(step.basis.row(2).isZero(0));
}

TEST(OneStep, TheCombinationsAreOrthonormalAfterProjection) {
  const Signature s = signature(80, 6, 1e-3);
  const Eigen::MatrixXd basis = orthonormal_combinations(s, everything(6));
  EXPECT_TRUE((basis.transpose() * s.gram() * basis).isApprox(Eigen::MatrixXd::Identity(6, 6), 1e-8));
}

/// Two columns that are one to rounding, or to less than what counts as absorbed, have one rank.
TEST(OneStep, WhatIsAbsorbedHasNoRank) {
  for (const double apart : {0.0, 1e-8}) {
    const Signature s = signature(80, 6, apart);
    const Eigen::MatrixXd basis = orthonormal_combinations(s, everything(6));
    EXPECT_EQ(basis.cols(), 5) << apart;
    EXPECT_TRUE((basis.transpose() * s.gram() * basis).isApprox(Eigen::MatrixXd::Identity(5, 5), 1e-6));
  }
  EXPECT_EQ(orthonormal_combinations(signature(80, 6, 0.05), everything(6)).cols(), 6);
  EXPECT_LT(orthonormal_combinations(signature(80, 6, 0.05, 0.3), everything(6)).cols(), 6);
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
