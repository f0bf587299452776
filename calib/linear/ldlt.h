// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace mgtd::calib::linear {

/// solve_by_ldlt() solves A x = b for a symmetric matrix A that may be singular, by LDL' with pivoting. A
/// direction whose pivot is zero gets nothing. Never refused: where a singular matrix is an error, use
/// Cholesky.
[[nodiscard]] Eigen::VectorXd solve_by_ldlt(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
[[nodiscard]] Eigen::MatrixXd solve_by_ldlt(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// The same once the diagonal of A, nowhere negative, is scaled to one: D A D (D^-1 x) = D b with D =
/// diag(A)^-1/2, 1 where the diagonal is zero. `ridge` is added to that diagonal: with it, a direction that
/// nothing determines gets next to nothing.
[[nodiscard]] Eigen::VectorXd solve_by_scaled_ldlt(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
[[nodiscard]] Eigen::MatrixXd solve_by_scaled_ldlt(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                                                   double ridge = 0);

}  // namespace mgtd::calib::linear
