// SPDX-License-Identifier: Apache-2.0
#include "calib/stats/f_distribution.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "calib/stats/chi_square.h"

namespace mgtd::calib::stats {
namespace {

TEST(FDistribution, IsTheClosedFormForTwoDegreesOfFreedom) {
  // P(F > f) = (1 + 2 f / nu)^(-nu / 2), from the bulk to far beyond what a double holds.
  for (const double nu : {3.0, 20.0, 160.0, 2000.0}) {
    for (const double f : {1e-3, 0.5, 1.0, 5.0, 100.0, 1e5}) {
      const double exact = -nu / 2 * std::log1p(2 * f / nu) / std::log(10.0);
      EXPECT_NEAR(f_log10_p(f, 2, nu), exact, 1e-10 * (1 + std::abs(exact))) << f << " " << nu;
    }
  }
}

TEST(FDistribution, AgreesWithTables) {
  EXPECT_NEAR(std::pow(10, f_log10_p(4.9646, 1, 10)), 0.05, 1e-5);
  EXPECT_NEAR(std::pow(10, f_log10_p(4.1027, 5, 20)), 0.01, 1e-6);
}

TEST(FDistribution, AgreesWithBoostAsFarAsADoubleHoldsAndGoesOnBeyond) {
  const auto boosts = [](double f, double k, double nu) {
    return boost::math::ibeta(nu / 2, k / 2, nu / (nu + k * f));
  };
  for (const double k : {1.0, 4.0, 12.0}) {
    for (const double nu : {3.0, 40.0, 900.0}) {
      for (const double f : {0.2, 1.0, 3.0, 20.0})
        EXPECT_NEAR(f_log10_p(f, k, nu), std::log10(boosts(f, k, nu)), 1e-10) << f << ' ' << k << ' ' << nu;
    }
  }
  EXPECT_EQ(boosts(1e4, 12, 900), 0);
  EXPECT_NEAR(f_log10_p(1e4, 12, 900), -946.4975961197, 1e-6);
}

TEST(FDistribution, WithoutALimitToTheNoiseIsTheChiSquare) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(f_log10_p(3, 12, inf), chi_square_log10_p(36, 12));
  EXPECT_NEAR(f_log10_p(3, 12, 1e7), chi_square_log10_p(36, 12), 1e-4);
  EXPECT_EQ(f_log10_p(-1, 3, 5), 0);
  EXPECT_EQ(f_log10_p(inf, 3, 5), -inf);
  EXPECT_TRUE(std::isnan(f_log10_p(1, 3, std::nan(""))));
}

/// Neither 1 - x of an x near one nor a difference of large logarithms of the gamma function has them.
TEST(FDistribution, KeepsItsDigitsWhereTheNoiseIsKnownWell) {
  for (const double f : {0.5, 3.0, 20.0})
    EXPECT_NEAR(f_log10_p(f, 12, 1e12), chi_square_log10_p(12 * f, 12), 1e-8) << f;
}

/// P(|t| > 1e6) with one degree of freedom is 2/pi of 1e-6.
TEST(FDistribution, KeepsItsDigitsFarOut) {
  EXPECT_NEAR(f_log10_p(1e12, 1, 1), std::log10(2e-6 / std::numbers::pi), 1e-11);
}

/// P(|t| < 1e-6) with 40 degrees of freedom is 2e-6 of the density at zero.
TEST(FDistribution, KeepsItsDigitsNearOne) {
  EXPECT_NEAR(f_log10_p(1e-12, 1, 40) / -3.443582459417e-07, 1, 1e-9);
  EXPECT_NEAR(f_log10_p(0.5, 300, 900) / -1.2281e-12, 1, 1e-4);
}

}  // namespace
}  // namespace mgtd::calib::stats
