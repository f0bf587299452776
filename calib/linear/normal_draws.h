// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace mgtd::calib::linear {

/// Draws from the normal distribution with mean zero and this covariance, which must be positive definite:
/// one column each. Only the lower triangle is read. The same seed gives the same draws.
[[nodiscard]] Eigen::MatrixXd normal_draws(const Eigen::MatrixXd& covariance, Eigen::Index draws,
                                           std::uint64_t seed);

}  // namespace mgtd::calib::linear
