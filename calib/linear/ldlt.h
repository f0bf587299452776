// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace mgtd::calib::linear {

/// The x of A x = b for a symmetric matrix A that may be singular, by LDL' with pivoting. A direction whose
/// pivot is zero gets nothing. Never refused: where a singular matrix is an error, use Cholesky.
[[nodiscard]] Eigen::VectorXd solve_by_ldlt(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
[[nodiscard]] Eigen::MatrixXd solve_by_ldlt(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace mgtd::calib::linear
