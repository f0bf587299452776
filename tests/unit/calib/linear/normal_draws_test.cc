// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/normal_draws.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mgtd::calib::linear {
namespace {

const Eigen::MatrixXd kCovariance{{4, 3}, {3, 9}};

TEST(NormalDraws, HaveTheMeanZeroAndTheCovarianceTheyWereAskedFor) {
  constexpr Eigen::Index kDraws = 20'000;
  const Eigen::MatrixXd x = normal_draws(kCovariance, kDraws, 7);
  ASSERT_EQ(x.rows(), 2);
  ASSERT_EQ(x.cols(), kDraws);
  // Five standard errors: of a mean sd/sqrt(n), of a variance sqrt(2/n) of itself.
  EXPECT_NEAR(x.row(0).mean(), 0, 5 * 2 / std::sqrt(kDraws));
  EXPECT_NEAR(x.row(1).mean(), 0, 5 * 3 / std::sqrt(kDraws));
  const Eigen::MatrixXd seen = x * x.transpose() / static_cast<double>(kDraws);
  EXPECT_TRUE(seen.isApprox(kCovariance, 5 * std::sqrt(2.0 / kDraws))) << seen;
}

TEST(NormalDraws, TheSameSeedGivesTheSameAndAnotherSeedOthers) {
  EXPECT_EQ(normal_draws(kCovariance, 5, 7), normal_draws(kCovariance, 5, 7));
  EXPECT_NE(normal_draws(kCovariance, 5, 7), normal_draws(kCovariance, 5, 8));
}

}  // namespace
}  // namespace mgtd::calib::linear
