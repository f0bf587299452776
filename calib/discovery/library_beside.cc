// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/library_beside.h"

#include <Eigen/QR>
#include <utility>

#include "calib/linear/product.h"

namespace mgtd::calib::discovery {
namespace {

namespace tests = criticism::tests;

/// Of the length of a column, below which what the laws leave of it is rounding.
constexpr double kTakenUp = 1e-4;

/// Orthonormal, projected as the residual.
Eigen::MatrixXd directions_of(const Workbench& bench, const std::vector<const FittedLaw*>& laws,
                              const Eigen::MatrixXd& of_gradient) {
  std::vector<Eigen::VectorXd> rows;
  for (const FittedLaw* law : laws)
    for (const LawOnChannels& direction : law->basis)
      rows.push_back(law_rows(direction, bench.problem, of_gradient));
  if (rows.empty()) return {bench.residual.value().size(), 0};
  Eigen::MatrixXd side_by_side(rows.front().size(), static_cast<Eigen::Index>(rows.size()));
  for (std::size_t j = 0; j < rows.size(); ++j) side_by_side.col(static_cast<Eigen::Index>(j)) = rows[j];
  const Eigen::MatrixXd projected = bench.residual.project(side_by_side).projected;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(projected);
  return qr.householderQ() * Eigen::MatrixXd::Identity(projected.rows(), qr.rank());
}

Eigen::MatrixXd without(const Eigen::MatrixXd& directions, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd out = columns;
  linear::subtract_product(directions, linear::transposed_product(directions, columns), out);
  return out;
}

}  // namespace

std::vector<tests::ScoredFamily> library_beside(const Workbench& bench,
                                                const std::vector<const FittedLaw*>& laws,
                                                const Eigen::MatrixXd& of_gradient) {
  const Eigen::MatrixXd directions = directions_of(bench, laws, of_gradient);
  const Eigen::VectorXd residual = without(directions, bench.residual.value());
  std::vector<tests::ScoredFamily> out;
  for (const tests::ScoredFamily& family : bench.library) {
    tests::ScoredFamily beside{.candidate_effect = family.candidate_effect, .own = family.own};
    for (const tests::Signature& signature : family.signatures) {
      const Eigen::MatrixXd before = signature.times(signature.seen());
      Eigen::MatrixXd left = without(directions, before);
      for (Eigen::Index j = 0; j < left.cols(); ++j)
        if (left.col(j).norm() < kTakenUp * before.col(j).norm()) left.col(j).setZero();
      beside.signatures.emplace_back(std::move(left), residual, signature.absorbed());
      beside.score_last(bench.noise);
      beside.signatures.back() = tests::Signature(Eigen::MatrixXd(0, 0), Eigen::VectorXd(0));
    }
    out.push_back(std::move(beside));
  }
  return out;
}

}  // namespace mgtd::calib::discovery
