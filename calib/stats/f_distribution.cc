// SPDX-License-Identifier: Apache-2.0
#include "calib/stats/f_distribution.h"

#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "calib/stats/boost_policy.h"
#include "calib/stats/chi_square.h"
#include "calib/stats/log_gamma.h"

namespace mgtd::calib::stats {
namespace {

constexpr int kBetaTerms = 10'000;
constexpr double kBetaExact = 1e-15, kBetaTiny = 1e-300;

/// Continued fraction of the incomplete beta function (Lentz), for x < (a + 1)/(a + b + 2).
double fraction(double a, double b, double x) {
  const auto away = [](double v) { return std::abs(v) < kBetaTiny ? kBetaTiny : v; };
  double c = 1, d = 1 / away(1 - (a + b) * x / (a + 1)), h = d;
  for (int m = 1; m < kBetaTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away(1 + even * d);
    c = away(1 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away(1 + odd * d);
    c = away(1 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1) < kBetaExact) break;
  }
  return h;
}

/// ln I_x(a, b), for the same x.
double log_beta_ratio(double a, double b, double x) {
  return log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * std::log(x) + b * std::log1p(-x) +
         std::log(fraction(a, b, x) / a);
}

}  // namespace

double f_log10_p(double f, double k, double nu) {
  if (!(f > 0) || !(k > 0)) return 0;
  if (std::isnan(nu)) return nu;
  if (std::isinf(nu)) return chi_square_log10_p(k * f, k);
  const double a = nu / 2, b = k / 2;
  // I_x(a, b) = 1 - I_y(b, a), y = 1 - x: the smaller of the two keeps its digits.
  const double x = 1 / (1 + k * f / nu), y = 1 / (1 + nu / (k * f));
  const double p =
      x < y ? boost::math::ibeta(a, b, x, BoostPolicy()) : boost::math::ibetac(b, a, y, BoostPolicy());
  if (p < kLeastBoostTail) return log_beta_ratio(a, b, x) / std::log(10.0);
  if (p <= 0.5) return std::log10(p);
  const double below =
      x < y ? boost::math::ibetac(a, b, x, BoostPolicy()) : boost::math::ibeta(b, a, y, BoostPolicy());
  return std::log1p(-below) / std::log(10.0);
}

}  // namespace mgtd::calib::stats
