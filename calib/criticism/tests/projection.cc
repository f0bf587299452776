// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/projection.h"

#include <utility>

#include "calib/linear/product.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// What the unknowns of the poses take whole is rounding, and no direction.
Eigen::MatrixXd without_rounding(Eigen::MatrixXd white, const Eigen::RowVectorXd& before) {
  for (Eigen::Index j = 0; j < white.cols(); ++j)
    if (white.col(j).norm() < kRankTolerance * before[j]) white.col(j).setZero();
  return white;
}

}  // namespace

Projection::Projection(Whitener whitener, Eigen::MatrixXd basis)
    : whitener_(std::move(whitener)), basis_(std::move(basis)) {}

Projection::Columns Projection::project(const Eigen::MatrixXd& rows) const {
  const Eigen::MatrixXd white = without_rounding(whitener_.apply(rows), rows.colwise().norm());
  Columns out{.projected = Eigen::MatrixXd::Zero(basis_.rows(), rows.cols()), .norms = {}};
  out.norms = white.colwise().norm();
  out.projected.topRows(white.rows()) = white;
  linear::subtract_product(basis_, linear::transposed_product(basis_.topRows(white.rows()), white),
                           out.projected);
  return out;
}

}  // namespace mgtd::calib::criticism::tests
