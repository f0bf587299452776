// SPDX-License-Identifier: Apache-2.0
#include "calib/stats/chi_square.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

namespace mgtd::calib::stats {
namespace {

TEST(ChiSquare, AgreesWithClosedForms) {
  // Two degrees of freedom: exp(-x/2). One: erfc(sqrt(x/2)).
  for (const double x : {0.1, 1.0, 2.9, 3.1, 10.0, 80.0}) {
    EXPECT_NEAR(chi_square_p(x, 2) / std::exp(-x / 2), 1, 1e-12) << x;
    EXPECT_NEAR(chi_square_p(x, 1) / std::erfc(std::sqrt(x / 2)), 1, 1e-12) << x;
  }
}

TEST(ChiSquare, TabulatedLimits) {
  EXPECT_NEAR(chi_square_p(18.307, 10), 0.05, 1e-5);
  EXPECT_NEAR(chi_square_p(124.342, 100), 0.05, 1e-5);
  EXPECT_NEAR(chi_square_p(1000, 1000), 0.494, 1e-3);
}

TEST(ChiSquare, LimitIsTheInverse) {
  EXPECT_NEAR(chi_square_limit(0.05, 10), 18.307038, 1e-6);
  for (const double p : {1e-12, 1e-3, 0.5, 0.999})
    EXPECT_NEAR(chi_square_p(chi_square_limit(p, 7), 7) / p, 1, 1e-8);
}

TEST(ChiSquare, AgreesWithBoostAsFarAsADoubleHolds) {
  for (const double dof : {1.0, 3.0, 12.0, 150.0, 4000.0}) {
    for (const double ratio : {0.3, 0.9, 1.0, 1.1, 2.0, 30.0}) {
      const double x = ratio * dof, p = boost::math::gamma_q(dof / 2, x / 2);
      if (p < 1e-290) continue;
      EXPECT_NEAR(chi_square_log10_p(x, dof), std::log10(p), 1e-11 * (1 + x)) << x << ' ' << dof;
    }
  }
}

/// Why the logarithm is written by hand.
TEST(ChiSquare, LogarithmGoesOnWhereBoostsProbabilityIsZero) {
  EXPECT_EQ(boost::math::gamma_q(6.0, 2000.0), 0);
  EXPECT_NEAR(chi_square_log10_p(4000, 12), -854.1619085236, 1e-8);
}

/// Where Boost.Math's probability ends, the continued fraction goes on without a step.
TEST(ChiSquare, LogarithmIsSmoothWhereTheContinuedFractionTakesOver) {
  for (const double dof : {1.0, 12.0, 150.0}) {
    const double x = chi_square_limit(1e-290, dof), h = x * 1e-6;
    const double left = chi_square_log10_p(x - h, dof), here = chi_square_log10_p(x, dof),
                 right = chi_square_log10_p(x + h, dof);
    EXPECT_NEAR(here, -290, 1e-9);
    EXPECT_NEAR((right - 2 * here + left) / (right - left), 0, 1e-5) << dof;
  }
}

TEST(ChiSquare, NothingIsSaidOfWhatIsNotANumber) {
  EXPECT_TRUE(std::isnan(chi_square_p(std::nan(""), 3)));
  EXPECT_TRUE(std::isnan(chi_square_log10_p(std::nan(""), 3)));
  EXPECT_EQ(chi_square_p(1e12, 3), 0);
}

TEST(ChiSquare, LogarithmDoesNotUnderflow) {
  EXPECT_NEAR(chi_square_log10_p(1e5, 2), -5e4 / std::log(10.0), 1e-6);
  EXPECT_EQ(chi_square_p(0, 5), 1);
}

}  // namespace
}  // namespace mgtd::calib::stats
