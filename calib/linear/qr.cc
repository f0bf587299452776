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
  Eigen::MatrixXd Q, rotation;
  Eigen::VectorXd row;
};

TriangularisingRotation::TriangularisingRotation() : work_(std::make_unique<Work>()) {}
TriangularisingRotation::~TriangularisingRotation() = default;

const Eigen::MatrixXd& TriangularisingRotation::of(const Eigen::Ref<const Eigen::MatrixXd>& X) {
  work_->qr.compute(X);
  work_->row.resize(X.rows());
  work_->qr.householderQ().evalTo(work_->Q, work_->row);
  work_->rotation = work_->Q.transpose();
  return work_->rotation;
}

}  // namespace mgtd::calib::linear
