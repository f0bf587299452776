// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

/// These functions propagate errors to first order: they say what y = f(x) inherits from an x of covariance
/// C, with the Jacobian J = df/dx. They are templates, so that small matrices keep their fixed size in the
/// loop over the samples.
namespace mgtd::calib::linear {

/// J C J': the covariance of y.
template <typename Jacobian, typename Covariance>
[[nodiscard]] auto propagated_covariance(const Eigen::MatrixBase<Jacobian>& J,
                                         const Eigen::MatrixBase<Covariance>& C) {
  constexpr int kRows = Jacobian::RowsAtCompileTime;
  return Eigen::Matrix<double, kRows, kRows>(J * C * J.transpose());
}

/// The diagonal of J C J' alone: the variances of y.
template <typename Jacobian, typename Covariance>
[[nodiscard]] auto propagated_variances(const Eigen::MatrixBase<Jacobian>& J,
                                        const Eigen::MatrixBase<Covariance>& C) {
  return Eigen::Matrix<double, Jacobian::RowsAtCompileTime, 1>((J * C * J.transpose()).diagonal());
}

/// g' C g: the variance of a single y with the gradient g, a column.
template <typename Gradient, typename Covariance>
[[nodiscard]] double propagated_variance(const Eigen::MatrixBase<Gradient>& g,
                                         const Eigen::MatrixBase<Covariance>& C) {
  return g.dot(C * g);
}

}  // namespace mgtd::calib::linear
