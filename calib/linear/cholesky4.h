// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>

/// A Cholesky4 holds the factor L of a symmetric positive definite 4 x 4 matrix, H = L L'.
///
/// A joint fit factors one for each pose in each iteration. Eigen's LLT goes through its rows in loops of
/// unknown length and divides by the diagonal again and again; with the lengths known and the diagonal
/// inverted once this takes less than half the time (`bench`: factor_and_solve). An
/// unknown that rounding leaves no information about, after those before it, is held: whiten() and solve()
/// give zero for it.
namespace mgtd::calib::linear {

class Cholesky4 {
 public:
  /// Reads the lower triangle of H.
  explicit Cholesky4(const Eigen::Matrix4d& H) {
    for (int j = 0; j < 4; ++j) {
      double square = H(j, j);
      for (int k = 0; k < j; ++k) square -= L_(j, k) * L_(j, k);
      inverse_[j] = square > 0 ? 1 / std::sqrt(square) : 0;
      for (int i = j + 1; i < 4; ++i) {
        double product = H(i, j);
        for (int k = 0; k < j; ++k) product -= L_(i, k) * L_(j, k);
        L_(i, j) = product * inverse_[j];
      }
    }
  }

  /// Makes L^-1 X of X, which has four rows.
  template <class Rows>
  void whiten(Rows&& X) const {
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < i; ++k) X.row(i) -= L_(i, k) * X.row(k);
      X.row(i) *= inverse_[i];
    }
  }

  [[nodiscard]] Eigen::Vector4d whitened(Eigen::Vector4d x) const {
    whiten(x);
    return x;
  }

  /// H^-1 X.
  template <class Rows>
  [[nodiscard]] Rows solve(Rows X) const {
    whiten(X);
    for (int i = 3; i >= 0; --i) {
      for (int k = i + 1; k < 4; ++k) X.row(i) -= L_(k, i) * X.row(k);
      X.row(i) *= inverse_[i];
    }
    return X;
  }

 private:
  Eigen::Matrix4d L_;        ///< below its diagonal
  Eigen::Vector4d inverse_;  ///< of its diagonal
};

}  // namespace mgtd::calib::linear
