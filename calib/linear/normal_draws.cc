// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/normal_draws.h"

#include <algorithm>
#include <random>

#include "calib/linear/cholesky.h"

namespace mgtd::calib::linear {

Eigen::MatrixXd normal_draws(const Eigen::MatrixXd& covariance, Eigen::Index draws, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  const Eigen::MatrixXd independent =
      Eigen::MatrixXd::NullaryExpr(covariance.rows(), draws, [&] { return gauss(random); });
  if (covariance.rows() == 0) return independent;
  Eigen::MatrixXd raised = covariance;
  const double largest = std::max(covariance.diagonal().maxCoeff(), 1e-300);
  const auto factor = [&](double share) {
    raised.diagonal() = (covariance.diagonal().array().max(0) + share * largest).matrix();
    return Cholesky::of_unscaled(raised);
  };
  double share = 1e-9;
  auto cholesky = factor(share);
  while (!cholesky && share < 1) cholesky = factor(share *= 10);
  return cholesky.value().colour(independent);
}

}  // namespace mgtd::calib::linear
