// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

/// symmetric_eigen() gives the eigenvalues of a real symmetric matrix, ascending, and its eigenvectors,
/// orthonormal, as columns in the same order: A = V diag(values) V'. Only the lower triangle of A is read.
namespace mgtd::calib::linear {

struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);
[[nodiscard]] Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& A);

/// Of three by three: the principal axes of a scatter.
struct PrincipalAxes {
  Eigen::Vector3d values;
  Eigen::Matrix3d vectors;
};
[[nodiscard]] PrincipalAxes principal_axes(const Eigen::Matrix3d& A);

}  // namespace mgtd::calib::linear
