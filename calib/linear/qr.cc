// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/qr.h"

#include <Eigen/QR>

namespace mgtd::calib::linear {
namespace {

using Pivoted = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;
using Plain = Eigen::HouseholderQR<Eigen::MatrixXd>;

}  // namespace

Eigen::VectorXd least_squares(const Eigen::MatrixXd& X, const Eigen::VectorXd& y) {
  return Pivoted(X).solve(y);
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& X, const Eigen::MatrixXd& Y) {
  return Pivoted(X).solve(Y);
}

std::optional<Eigen::VectorXd> unique_least_squares(const Eigen::MatrixXd& X, const Eigen::VectorXd& y) {
  const Pivoted qr(X);
  if (qr.rank() < X.cols()) return std::nullopt;
  return Eigen::VectorXd(qr.solve(y));
}

Eigen::Index rank_of(const Eigen::MatrixXd& X) { return Pivoted(X).rank(); }

Eigen::MatrixXd column_space(Eigen::MatrixXd X, const Eigen::VectorXd& lengths, double tolerance) {
  const Eigen::VectorXd scale = (lengths.array() > 0).select(lengths.cwiseInverse(), 0.0);
  X *= scale.asDiagonal();
  Eigen::ColPivHouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(X);  // in place
  qr.setThreshold(tolerance);
  if (qr.rank() == 0)
    return Eigen::MatrixXd(X.rows(), 0);  // Eigen would take parts of a matrix that holds nothing
  return qr.householderQ() * Eigen::MatrixXd::Identity(X.rows(), qr.rank());
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& X) {
  return Plain(X).householderQ() * Eigen::MatrixXd::Identity(X.rows(), X.cols());
}

Eigen::MatrixXd complement_of(const Eigen::MatrixXd& X) {
  const Pivoted qr(X);
  const Eigen::MatrixXd Q = qr.householderQ();
  return Q.rightCols(X.rows() - qr.rank());
}

struct TriangularisingRotation::Work {
  Plain qr;
  Eigen::MatrixXd Q, rows, triangle;
  Eigen::VectorXd row;
};

TriangularisingRotation::TriangularisingRotation() : work_(std::make_unique<Work>()) {}
TriangularisingRotation::~TriangularisingRotation() = default;

void TriangularisingRotation::turn(const Eigen::Ref<const Eigen::MatrixXd>& X) {
  work_->qr.compute(X);
  work_->triangle = work_->qr.matrixQR().topRows(X.cols()).triangularView<Eigen::Upper>();
}

const Eigen::MatrixXd& TriangularisingRotation::triangle() const { return work_->triangle; }

const Eigen::MatrixXd& TriangularisingRotation::rows_from(Eigen::Index first) {
  const Eigen::Index n = work_->qr.rows();
  work_->Q.setZero(n, n - first);
  work_->Q.bottomRows(n - first).setIdentity();
  work_->qr.householderQ().applyThisOnTheLeft(work_->Q, work_->row);
  work_->rows = work_->Q.transpose();
  return work_->rows;
}

}  // namespace mgtd::calib::linear
