// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/cholesky.h"

#include <gmock/gmock.h>

#include <cmath>

namespace mgtd::calib::linear {
namespace {

using ::testing::HasSubstr;

/// Covariance of quantities whose units differ by 1e12, and its exact determinant.
Eigen::MatrixXd badly_scaled() { return Eigen::MatrixXd{{4, 2e-6, 0}, {2e-6, 5e-12, 1e-6}, {0, 1e-6, 9e12}}; }
constexpr double kDeterminant = 4 * (5e-12 * 9e12 - 1e-12) - 4e-12 * 9e12;

TEST(Cholesky, SolvesWhereTheUnitsDifferByTwelveDecades) {
  const Eigen::MatrixXd A = badly_scaled();
  const auto cholesky = Cholesky::of(A);
  ASSERT_TRUE(cholesky);
  const Eigen::VectorXd x = cholesky->solve(Eigen::VectorXd(A.col(1)));
  EXPECT_NEAR(x[0], 0, 1e-20);
  EXPECT_NEAR(x[1], 1, 1e-14);
  EXPECT_NEAR(x[2], 0, 1e-24);
  const Eigen::MatrixXd one = cholesky->solve(A);
  EXPECT_TRUE(one.diagonal().isOnes(1e-14)) << one;
  const Eigen::MatrixXd C = cholesky->inverse();
  for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(C.row(i).dot(A.col(i)), 1, 1e-12) << i;
}

TEST(Cholesky, DeterminantAndLengthsAreThoseOfTheMatrixAndNotOfTheScaledOne) {
  for (const bool scaled : {false, true}) {
    const auto cholesky = scaled ? Cholesky::of(badly_scaled()) : Cholesky::of_unscaled(badly_scaled());
    ASSERT_TRUE(cholesky);
    EXPECT_NEAR(cholesky->log_determinant(), std::log(kDeterminant), 1e-12);
    const Eigen::VectorXd b = Eigen::VectorXd{{3, 1e-6, 2e6}};
    const double length2 = b.dot(cholesky->solve(b));
    EXPECT_NEAR(cholesky->squared_length(b) / length2, 1, 1e-14);
    EXPECT_NEAR(cholesky->whiten(b).squaredNorm() / length2, 1, 1e-14);
  }
}

TEST(Cholesky, WhitenedColumnsHaveTheCovarianceOne) {
  const Eigen::MatrixXd A{{4, 2}, {2, 10}};
  const auto cholesky = Cholesky::of(A);
  ASSERT_TRUE(cholesky);
  const Eigen::MatrixXd W = cholesky->whiten(Eigen::MatrixXd(Eigen::MatrixXd::Identity(2, 2)));
  EXPECT_TRUE(cholesky->whiten_rows(Eigen::MatrixXd::Identity(2, 2)).isApprox(W.transpose(), 1e-14));
  const Eigen::MatrixXd one = W * A * W.transpose();
  EXPECT_TRUE(one.isIdentity(1e-14)) << one;
}

TEST(Cholesky, ColouringIsTheWayBackFromWhitening) {
  const auto cholesky = Cholesky::of(badly_scaled());
  ASSERT_TRUE(cholesky);
  const Eigen::MatrixXd root = cholesky->colour(Eigen::MatrixXd::Identity(3, 3));
  EXPECT_TRUE(cholesky->whiten(root).isIdentity(1e-13));
  const Eigen::VectorXd d = badly_scaled().diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd seen = d.asDiagonal() * root * root.transpose() * d.asDiagonal(),
                        expected = d.asDiagonal() * badly_scaled() * d.asDiagonal();
  EXPECT_TRUE(seen.isApprox(expected, 1e-14)) << seen;
}

TEST(Cholesky, RefusesWhatIsNotPositiveDefinite) {
  for (const Eigen::MatrixXd& A :
       {Eigen::MatrixXd{{1, 2}, {2, 1}}, Eigen::MatrixXd{{1, 0}, {0, 0}}, Eigen::MatrixXd{{1, 0}, {0, -3}},
        Eigen::MatrixXd{{std::nan(""), 0}, {0, 1}}}) {
    const auto cholesky = Cholesky::of(A);
    ASSERT_FALSE(cholesky) << A;
    EXPECT_EQ(cholesky.error().code, ErrorCode::refused);
    EXPECT_THAT(cholesky.error().message, HasSubstr("2 rows is not positive definite"));
  }
}

TEST(Cholesky, OfNothingIsNothing) {
  const auto cholesky = Cholesky::of(Eigen::MatrixXd(0, 0));
  ASSERT_TRUE(cholesky);
  EXPECT_EQ(cholesky->log_determinant(), 0);
  EXPECT_EQ(cholesky->inverse().size(), 0);
}

}  // namespace
}  // namespace mgtd::calib::linear
