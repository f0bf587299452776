// SPDX-License-Identifier: Apache-2.0
#include "calib/stats/chi_square.h"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "calib/stats/boost_policy.h"
#include "calib/stats/log_gamma.h"

namespace mgtd::calib::stats {
namespace {

constexpr int kGammaTerms = 10'000;
constexpr double kGammaExact = 1e-16;

/// ln Q(a, x), x >= a + 1 (Lentz).
double log_upper(double a, double x) {
  constexpr double kTiny = 1e-300;
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, h = d;
  for (int n = 1; n < kGammaTerms; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = an * d + b;
    d = 1 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    h *= d * c;
    if (std::abs(d * c - 1) < kGammaExact) break;
  }
  return a * std::log(x) - x - log_gamma(a) + std::log(h);
}

}  // namespace

double chi_square_p(double x, double dof) {
  if (std::isnan(x)) return x;
  if (!(x > 0) || !(dof > 0)) return 1;
  return boost::math::gamma_q(dof / 2, x / 2, BoostPolicy());
}

double chi_square_log10_p(double x, double dof) {
  const double p = chi_square_p(x, dof);
  if (p < kLeastBoostTail) return log_upper(dof / 2, x / 2) / std::log(10.0);
  if (p <= 0.5 || !(x > 0) || !(dof > 0)) return std::log10(p);
  return std::log1p(-boost::math::gamma_p(dof / 2, x / 2, BoostPolicy())) / std::log(10.0);
}

double chi_square_limit(double p, double dof) {
  return 2 * boost::math::gamma_q_inv(dof / 2, p, BoostPolicy());
}

double chi_square_alike(double x, double dof, double other_dof) {
  return dof == other_dof ? x : chi_square_limit(chi_square_p(x, dof), other_dof);
}

}  // namespace mgtd::calib::stats
