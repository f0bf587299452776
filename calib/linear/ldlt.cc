// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/ldlt.h"

#include <Eigen/Cholesky>

namespace mgtd::calib::linear {
namespace {

Eigen::VectorXd to_unit_diagonal(const Eigen::MatrixXd& A) {
  return A.diagonal().cwiseSqrt().unaryExpr([](double x) { return x > 0 ? 1 / x : 1; });
}

}  // namespace

Eigen::VectorXd solve_by_ldlt(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.ldlt().solve(b);
}

Eigen::MatrixXd solve_by_ldlt(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

Eigen::VectorXd solve_by_scaled_ldlt(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  const Eigen::VectorXd d = to_unit_diagonal(A);
  return d.cwiseProduct(
      solve_by_ldlt(d.asDiagonal() * A * d.asDiagonal(), Eigen::VectorXd(d.cwiseProduct(b))));
}

Eigen::MatrixXd solve_by_scaled_ldlt(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double ridge) {
  const Eigen::VectorXd d = to_unit_diagonal(A);
  Eigen::MatrixXd scaled = d.asDiagonal() * A * d.asDiagonal();
  scaled.diagonal().array() += ridge;
  return d.asDiagonal() * solve_by_ldlt(scaled, Eigen::MatrixXd(d.asDiagonal() * B));
}

}  // namespace mgtd::calib::linear
