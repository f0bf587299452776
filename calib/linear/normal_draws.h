// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace mgtd::calib::linear {

/// Draws from the normal distribution with mean zero and this covariance, one column each. Rounding, or
/// variables that are one, may keep it from being positive definite: its diagonal is raised by a part in 1e9,
/// or by as little more as is enough. Only the lower triangle is read. The same seed gives the same draws.
[[nodiscard]] Eigen::MatrixXd normal_draws(const Eigen::MatrixXd& covariance, Eigen::Index draws,
                                           std::uint64_t seed);

}  // namespace mgtd::calib::linear
