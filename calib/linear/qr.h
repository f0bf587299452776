// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>

/// These functions solve least squares and find orthonormal bases of columns, by Householder QR.
namespace mgtd::calib::linear {

/// The b of least |y - X b|, columns pivoted. Of a column that depends on the others b is zero.
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& X, const Eigen::VectorXd& y);
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& X, const Eigen::MatrixXd& Y);
/// The same where the columns are independent, else nothing.
[[nodiscard]] std::optional<Eigen::VectorXd> unique_least_squares(const Eigen::MatrixXd& X,
                                                                  const Eigen::VectorXd& y);
/// Number of independent columns.
[[nodiscard]] Eigen::Index rank_of(const Eigen::MatrixXd& X);

/// Orthonormal basis of the space of the columns, each divided by its length in `lengths` first (a length of
/// zero leaves the column out): what then is shorter than `tolerance` times the longest counts as dependent.
[[nodiscard]] Eigen::MatrixXd column_space(Eigen::MatrixXd X, const Eigen::VectorXd& lengths,
                                           double tolerance);
/// Orthonormal basis of columns that are known to be independent, one for each and in their order.
[[nodiscard]] Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& X);
/// Orthonormal basis of what is perpendicular to all columns.
[[nodiscard]] Eigen::MatrixXd complement_of(const Eigen::MatrixXd& X);
/// Q' of X = Q R, square: the first rows of Q' X, as many as X has columns, hold the triangle R, the others
/// are zero. For many small X of one size, one after the other: allocates for the first alone. What it gives
/// holds until the next X.
class TriangularisingRotation {
 public:
  TriangularisingRotation();
  ~TriangularisingRotation();
  TriangularisingRotation(const TriangularisingRotation&) = delete;
  TriangularisingRotation& operator=(const TriangularisingRotation&) = delete;

  void turn(const Eigen::Ref<const Eigen::MatrixXd>& X);
  /// Of the last X: R, as wide as X, and the rows of Q' from one on.
  [[nodiscard]] const Eigen::MatrixXd& triangle() const;
  [[nodiscard]] const Eigen::MatrixXd& rows_from(Eigen::Index first);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace mgtd::calib::linear
