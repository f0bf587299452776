// SPDX-License-Identifier: Apache-2.0
#include "calib/stats/chi_square.h"

#include <boost/math/tools/roots.hpp>
#include <cmath>

#include "calib/stats/log_gamma.h"

namespace mgtd::calib::stats {
namespace {

constexpr int kGammaTerms = 10'000;
constexpr double kGammaExact = 1e-16;

double log_front(double a, double x) { return a * std::log(x) - x - log_gamma(a); }

/// ln P(a, x), x < a + 1.
double log_lower(double a, double x) {
  double term = 1 / a, sum = term;
  for (int n = 1; n < kGammaTerms && term > kGammaExact * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return log_front(a, x) + std::log(sum);
}

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
  return log_front(a, x) + std::log(h);
}

double log_p(double x, double dof) {
  if (std::isnan(x)) return x;
  if (!(x > 0) || !(dof > 0)) return 0;
  const double a = dof / 2, half = x / 2;
  return half < a + 1 ? std::log1p(-std::exp(log_lower(a, half))) : log_upper(a, half);
}

}  // namespace

double chi_square_p(double x, double dof) { return std::exp(log_p(x, dof)); }
double chi_square_log10_p(double x, double dof) { return log_p(x, dof) / std::log(10.0); }

double chi_square_alike(double x, double dof, double other_dof) {
  return dof == other_dof ? x : chi_square_limit(chi_square_p(x, dof), other_dof);
}

double chi_square_limit(double p, double dof) {
  const auto excess = [&](double x) { return log_p(x, dof) - std::log(p); };
  const auto near = [](double low, double high) { return high - low <= 1e-11 * high; };
  double beyond = dof + 1;
  while (excess(beyond) > 0) beyond *= 2;
  const auto [low, high] = boost::math::tools::bisect(excess, 0.0, beyond, near);
  return 0.5 * (low + high);
}

}  // namespace mgtd::calib::stats
