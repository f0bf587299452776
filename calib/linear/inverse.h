// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace mgtd::calib::linear {

/// inverse_by_lu() inverts a square matrix by LU with partial pivoting. The matrix is taken to be regular: of
/// a singular one the inverse is not finite. Where it may be singular and is a covariance or information, use
/// Cholesky, which refuses.
[[nodiscard]] Eigen::MatrixXd inverse_by_lu(const Eigen::MatrixXd& A);

}  // namespace mgtd::calib::linear
