// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/qr.h"

#include <gtest/gtest.h>

namespace mgtd::calib::linear {
namespace {

/// A constant and a slope over four places.
const Eigen::MatrixXd kLine{{1, 0}, {1, 1}, {1, 2}, {1, 3}};
/// The same and their sum.
const Eigen::MatrixXd kDependent{{1, 0, 1}, {1, 1, 2}, {1, 2, 3}, {1, 3, 4}};
const Eigen::VectorXd kY{{1, 0, 2, 5}};  // best line: -0.1 + 1.4 x

TEST(LeastSquares, OfALineThroughFourPoints) {
  const Eigen::VectorXd expected{{-0.1, 1.4}};
  EXPECT_TRUE(least_squares(kLine, kY).isApprox(expected, 1e-13)) << least_squares(kLine, kY);
  EXPECT_TRUE(least_squares(kLine, Eigen::MatrixXd(kY)).isApprox(expected, 1e-13));
  ASSERT_TRUE(unique_least_squares(kLine, kY));
  EXPECT_TRUE(unique_least_squares(kLine, kY)->isApprox(expected, 1e-13));
}

TEST(LeastSquares, DependentColumnsAreCountedAndHaveNoUniqueSolution) {
  EXPECT_EQ(rank_of(kLine), 2);
  EXPECT_EQ(rank_of(kDependent), 2);
  EXPECT_FALSE(unique_least_squares(kDependent, kY));
  const Eigen::VectorXd fitted = kDependent * least_squares(kDependent, kY), line{{-0.1, 1.3, 2.7, 4.1}};
  EXPECT_TRUE(fitted.isApprox(line, 1e-13)) << fitted;
}

TEST(Bases, SpanTheColumnsOrWhatIsPerpendicularToThem) {
  const Eigen::MatrixXd Q = orthonormal(kLine), N = complement_of(kDependent);
  ASSERT_EQ(Q.cols(), 2);
  ASSERT_EQ(N.cols(), 2);
  EXPECT_TRUE((Q.transpose() * Q).isIdentity(1e-14));
  EXPECT_TRUE((N.transpose() * N).isIdentity(1e-14));
  EXPECT_TRUE((N.transpose() * kLine).isZero(1e-14));
  EXPECT_TRUE((N.transpose() * Q).isZero(1e-14));
}

TEST(Bases, ColumnsThatAreRoundingAgainstTheirLengthAreLeftOut) {
  Eigen::MatrixXd X = kLine;
  X.col(1) *= 1e-12;  // what elimination left of a column that was of length one
  const Eigen::VectorXd own = X.colwise().norm(), before = Eigen::VectorXd::Ones(2), none{{1, 0}};
  EXPECT_EQ(column_space(X, own, 1e-9).cols(), 2);
  EXPECT_EQ(column_space(X, before, 1e-9).cols(), 1);
  EXPECT_EQ(column_space(X, none, 1e-9).cols(), 1);
  EXPECT_EQ(column_space(Eigen::MatrixXd::Zero(3, 2), before, 1e-9).cols(), 0);
}

TEST(TriangularisingRotation, LeavesNothingBelowTheTriangle) {
  TriangularisingRotation rotation;
  rotation.turn(kLine);
  const Eigen::MatrixXd T = rotation.rows_from(0) * kLine;
  ASSERT_EQ(T.rows(), 4);
  EXPECT_NEAR(T.col(0).squaredNorm(), 4, 1e-13);
  EXPECT_NEAR(T(1, 0), 0, 1e-14);
  EXPECT_TRUE(T.bottomRows(2).isZero(1e-14)) << T;
}

/// What one matrix left in the workspace must not show in the next, of the same size or another.
TEST(TriangularisingRotation, IsThatOfEachMatrixAndARotation) {
  TriangularisingRotation rotation;
  const Eigen::MatrixXd wide{{2, 1, 0}, {1, 3, 1}, {0, 1, 4}, {1, 1, 1}};
  for (const Eigen::MatrixXd& X : {kLine, wide, Eigen::MatrixXd(3 * kLine.array() + 1), wide}) {
    rotation.turn(X);
    const Eigen::MatrixXd Q = rotation.rows_from(0);
    EXPECT_TRUE((Q * Q.transpose()).isIdentity(1e-13));
    EXPECT_TRUE(rotation.triangle().isUpperTriangular(0)) << rotation.triangle();
    EXPECT_TRUE(((Q * X).topRows(X.cols()) - rotation.triangle()).isZero(1e-13));
    EXPECT_TRUE((Q * X).bottomRows(X.rows() - X.cols()).isZero(1e-13));
    EXPECT_EQ(Q.bottomRows(X.rows() - X.cols()), rotation.rows_from(X.cols()));
    TriangularisingRotation fresh;
    fresh.turn(X);
    EXPECT_EQ(Q, fresh.rows_from(0));
  }
}

}  // namespace
}  // namespace mgtd::calib::linear
