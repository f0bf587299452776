// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/normal_draws.h"

#include <random>

#include "calib/linear/cholesky.h"

namespace mgtd::calib::linear {

Eigen::MatrixXd normal_draws(const Eigen::MatrixXd& covariance, Eigen::Index draws, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  const Eigen::MatrixXd independent =
      Eigen::MatrixXd::NullaryExpr(covariance.rows(), draws, [&] { return gauss(random); });
  return Cholesky::of_unscaled(covariance).value().colour(independent);
}

}  // namespace mgtd::calib::linear
