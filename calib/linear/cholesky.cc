// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/cholesky.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <utility>

#include "calib/linear/product.h"

namespace mgtd::calib::linear {
namespace {

/// x becomes (L L')^-1 x.
template <typename Columns>
void solve_in_place(const Eigen::MatrixXd& L, Columns& x) {
  L.triangularView<Eigen::Lower>().solveInPlace(x);
  L.adjoint().triangularView<Eigen::Upper>().solveInPlace(x);
}

}  // namespace

Cholesky::Cholesky(Eigen::MatrixXd lower, Eigen::VectorXd scale)
    : lower_(std::move(lower)), scale_(std::move(scale)) {}

Result<Cholesky> Cholesky::scaled(const Eigen::MatrixXd& A, const Eigen::VectorXd& scale) {
  Eigen::MatrixXd lower = scale.asDiagonal() * A * scale.asDiagonal();
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(lower);  // in place
  if (!scale.allFinite() || llt.info() != Eigen::Success) {
    return fail(ErrorCode::refused,
                fmt::format("a matrix of {} rows is not positive definite: at least one combination of the "
                            "unknowns is not determined",
                            A.rows()),
                "add data that determine it, or hold one of the unknowns");
  }
  return Cholesky(std::move(lower), scale);
}

Result<Cholesky> Cholesky::of(const Eigen::MatrixXd& A) {
  return scaled(A, A.diagonal().cwiseSqrt().cwiseInverse());
}

Result<Cholesky> Cholesky::of_unscaled(const Eigen::MatrixXd& A) {
  return scaled(A, Eigen::VectorXd::Ones(A.rows()));
}

Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd x = scale_.cwiseProduct(b);
  solve_in_place(lower_, x);
  return scale_.cwiseProduct(x);
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& B) const {
  Eigen::MatrixXd x = scale_.asDiagonal() * B;
  solve_in_place(lower_, x);
  return scale_.asDiagonal() * x;
}

Eigen::MatrixXd Cholesky::inverse() const {
  Eigen::MatrixXd x = Eigen::MatrixXd::Identity(lower_.rows(), lower_.cols());
  solve_in_place(lower_, x);
  return scale_.asDiagonal() * x * scale_.asDiagonal();
}

double Cholesky::squared_length(const Eigen::VectorXd& b) const {
  const Eigen::VectorXd g = scale_.cwiseProduct(b);
  Eigen::VectorXd x = g;
  solve_in_place(lower_, x);
  return g.dot(x);
}

Eigen::VectorXd Cholesky::whiten(const Eigen::VectorXd& b) const {
  Eigen::VectorXd x = scale_.cwiseProduct(b);
  lower_.triangularView<Eigen::Lower>().solveInPlace(x);
  return x;
}

Eigen::MatrixXd Cholesky::whiten(const Eigen::MatrixXd& B) const {
  Eigen::MatrixXd x = scale_.asDiagonal() * B;
  lower_.triangularView<Eigen::Lower>().solveInPlace(x);
  return x;
}

Eigen::MatrixXd Cholesky::whiten_rows(Eigen::MatrixXd B) const {
  B *= scale_.asDiagonal();
  auto columns = B.transpose();
  lower_.triangularView<Eigen::Lower>().solveInPlace(columns);
  return B;
}

Eigen::MatrixXd Cholesky::colour(const Eigen::MatrixXd& Z) const {
  return scale_.cwiseInverse().asDiagonal() * triangle_product(lower_, Z);
}

double Cholesky::log_determinant() const {
  return 2 * (lower_.diagonal().array().log().sum() - scale_.array().log().sum());
}

}  // namespace mgtd::calib::linear
