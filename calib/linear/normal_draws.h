// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace mgtd::calib::linear {

/// normal_draws() draws random vectors from the normal distribution with mean zero and this covariance, one
/// in each column. Rounding, or variables that are one, may keep the covariance from being positive definite:
/// its diagonal is raised by a part in 1e9, or by as little more as is enough. Only the lower triangle is
/// read. The same seed gives the same draws.
[[nodiscard]] Eigen::MatrixXd normal_draws(const Eigen::MatrixXd& covariance, Eigen::Index draws,
                                           std::uint64_t seed);

}  // namespace mgtd::calib::linear
