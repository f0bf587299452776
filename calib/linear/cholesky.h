// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "proto/error.h"

namespace mgtd::calib::linear {

/// Cholesky decomposes a symmetric positive definite matrix A after its diagonal is scaled to one:
/// D A D = L L' with D = diag(A)^-1/2. The scaling takes the units out, so that nanotesla beside radians cost
/// no digits. Only the lower triangle of A is read.
class Cholesky {
 public:
  /// Refused where A is not positive definite: some combination of the unknowns is not determined.
  [[nodiscard]] static Result<Cholesky> of(const Eigen::MatrixXd& A);
  /// Of a matrix whose diagonal is of one size already: D = 1.
  [[nodiscard]] static Result<Cholesky> of_unscaled(const Eigen::MatrixXd& A);

  /// A^-1 b
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  [[nodiscard]] Eigen::MatrixXd inverse() const;
  /// b' A^-1 b: the squared length of b in units of its covariance A.
  [[nodiscard]] double squared_length(const Eigen::VectorXd& b) const;
  /// L^-1 D b: what has the covariance A then has the covariance 1.
  [[nodiscard]] Eigen::VectorXd whiten(const Eigen::VectorXd& b) const;
  [[nodiscard]] Eigen::MatrixXd whiten(const Eigen::MatrixXd& B) const;
  /// B D L'^-1: the same for rows.
  [[nodiscard]] Eigen::MatrixXd whiten_rows(Eigen::MatrixXd B) const;
  /// D^-1 L Z, the way back: what has the covariance 1 then has the covariance A.
  [[nodiscard]] Eigen::MatrixXd colour(const Eigen::MatrixXd& Z) const;
  /// ln det A
  [[nodiscard]] double log_determinant() const;

 private:
  Cholesky(Eigen::MatrixXd lower, Eigen::VectorXd scale);
  [[nodiscard]] static Result<Cholesky> scaled(const Eigen::MatrixXd& A, const Eigen::VectorXd& scale);

  Eigen::MatrixXd lower_;  ///< L; what is above its diagonal has no meaning
  Eigen::VectorXd scale_;  ///< diagonal of D
};

}  // namespace mgtd::calib::linear
