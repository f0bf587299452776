// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/heavy_tails.h"

#include <optional>

#include "calib/linear/cholesky.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// Of a pose that is left out, rows are rounding.
double excess_kurtosis_of(const Eigen::VectorXd& e, Eigen::Index poses, Eigen::Index rows) {
  constexpr double kRounding = 1e-12;
  double sum = 0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    double n = 0, squares = 0, fourths = 0;
    for (Eigen::Index k = 0; k < poses; ++k) {
      const double square = e[k * rows + row] * e[k * rows + row];
      n += square > kRounding ? 1 : 0, squares += square, fourths += square * square;
    }
    if (squares > 0) sum += n * fourths / (squares * squares) - 3;
  }
  return sum / static_cast<double>(rows);
}

/// The sum of c_k c_k'; nothing where one pose alone tells a coefficient.
std::optional<Eigen::MatrixXd> scatter(const Eigen::MatrixXd& U, const Eigen::VectorXd& e, Eigen::Index poses,
                                       Eigen::Index rows) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(U.cols(), U.cols());
  Eigen::MatrixXd V = Eigen::MatrixXd::Zero(U.cols(), U.cols());
  for (Eigen::Index k = 0; k < poses; ++k) {
    const auto of_pose = U.middleRows(k * rows, rows);
    const auto others = linear::Cholesky::of_unscaled(one - of_pose.transpose() * of_pose);
    if (!others) return std::nullopt;
    const Eigen::VectorXd says = of_pose.transpose() * e.segment(k * rows, rows);
    const Eigen::VectorXd c = others->solve(says);
    V += c * c.transpose();
  }
  return V;
}

}  // namespace

TailsBeside tails_beside(const ScoredFamily& family, const Residual& residual) {
  const Signature& s = family.signatures[family.winner().variant];
  const Eigen::MatrixXd basis = orthonormal_combinations(s, family.where());
  const Eigen::MatrixXd U = s.times(basis);
  const Eigen::VectorXd score = basis.transpose() * s.by_residual();
  const Eigen::VectorXd e = residual.value() - U * score;
  const Eigen::Index poses = residual.poses(), rows = residual.rows_per_pose();
  TailsBeside out{.excess_kurtosis = excess_kurtosis_of(e, poses, rows)};
  const auto V = scatter(U, e, poses, rows);
  if (!V) return out;
  const double spent = static_cast<double>(U.cols()) / static_cast<double>(poses);
  if (const auto cholesky = linear::Cholesky::of(*V))
    out.score_by_scatter = (1 - spent) * cholesky->squared_length(score);
  return out;
}

}  // namespace mgtd::calib::criticism::tests
