// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/ldlt.h"

#include <Eigen/Cholesky>

namespace mgtd::calib::linear {

Eigen::VectorXd solve_by_ldlt(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.ldlt().solve(b);
}

Eigen::MatrixXd solve_by_ldlt(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

}  // namespace mgtd::calib::linear
