// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/residual_shape.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "calib/criticism/tests/residual_columns.h"
#include "calib/criticism/tests/whitener.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/stats/boost_policy.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// Signed, 3N x P, in units of their own standard deviations; 0 where left out.
Eigen::MatrixXd own_units(const fit::joint::JointFit& fit) {
  const fit::joint::PoseResiduals sizes = fit::joint::pose_residuals(fit.problem, fit.state);
  Eigen::MatrixXd out = residuals_nT(fit);
  for (Eigen::Index k = 0; k < out.cols(); ++k)
    for (Eigen::Index c = 0; c < out.rows(); ++c)
      out(c, k) = std::copysign(fit.noise_inflation * static_cast<double>(sizes.t(c, k)), out(c, k));
  return out;
}

/// x with P(Beta(a, b) > x) = p.
double beta_upper(double a, double b, double p) {
  return boost::math::ibetac_inv(a, b, p, stats::BoostPolicy());
}

/// Chance of each order statistic to leave the envelope on one side.
double local_level(std::size_t n) {
  constexpr double kAlpha = 0.05, kSecond = 1.591;
  const double l = std::log(static_cast<double>(n)), ll = std::log(l);
  if (!(ll > 1)) return kAlpha / (2 * static_cast<double>(std::max<std::size_t>(n, 1)));
  return -std::log(1 - kAlpha) / (2 * ll * l) * (1 - kSecond * std::log(ll) / ll);
}

}  // namespace

double normal_quantile(double p) {
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p, stats::BoostPolicy());
}

ResidualQuantiles residual_quantiles(const fit::joint::JointFit& fit) {
  const Eigen::MatrixXd z = own_units(fit);
  std::vector<std::pair<double, int>> sorted;
  for (Eigen::Index k = 0; k < z.cols(); ++k)
    for (Eigen::Index c = 0; c < z.rows(); ++c)
      if (z(c, k) != 0)
        sorted.emplace_back(z(c, k), fit.problem.poses[static_cast<std::size_t>(k)].pose->number);
  std::sort(sorted.begin(), sorted.end());
  ResidualQuantiles out{.n = sorted.size()};
  if (sorted.empty()) return out;
  const double level = local_level(out.n), n = static_cast<double>(out.n);
  constexpr std::size_t kTails = 100;
  const std::size_t every = std::max<std::size_t>(1, out.n / (kMostQuantiles - 2 * kTails));
  for (std::size_t i = 0; i < out.n; ++i) {
    if (out.n > kMostQuantiles && i >= kTails && i + kTails < out.n && i % every != 0) continue;
    const double rank = static_cast<double>(i + 1), beyond = n + 1 - rank;
    out.quantile.push_back(normal_quantile((rank - 0.5) / n));
    out.residual.push_back(sorted[i].first);
    out.pose.push_back(sorted[i].second);
    out.high.push_back(normal_quantile(beta_upper(rank, beyond, level)));
    // The lower end of U_i is one less the upper end of the mirrored rank: no 1 - p of a small p is taken.
    out.low.push_back(-normal_quantile(beta_upper(beyond, rank, level)));
  }
  return out;
}

ResidualAutocorrelation residual_autocorrelation(const fit::joint::JointFit& fit, int lags) {
  const Eigen::MatrixXd z = own_units(fit);
  const std::vector<Eigen::Index> order = order_in_time(fit.problem);
  const Eigen::Index n = z.cols();
  ResidualAutocorrelation out;
  out.bound = 1.96 / std::sqrt(3.0 * static_cast<double>(std::max<Eigen::Index>(n, 1)));
  for (int s = 0; s < fit.problem.sensors(); ++s) {
    const auto rows = z.middleRows<3>(3 * s);
    std::vector<double>& r = out.by_sensor.emplace_back();
    for (Eigen::Index lag = 1; lag <= std::min<Eigen::Index>(lags, n - 1); ++lag) {
      double product = 0;
      for (Eigen::Index k = lag; k < n; ++k)
        product += rows.col(order[static_cast<std::size_t>(k)])
                       .dot(rows.col(order[static_cast<std::size_t>(k - lag)]));
      r.push_back(product / std::max(rows.squaredNorm(), 1e-300));
    }
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
