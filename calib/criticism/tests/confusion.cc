// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/confusion.h"

#include <algorithm>
#include <cmath>

#include "calib/criticism/tests/alternatives.h"
#include "calib/criticism/tests/detectable.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// The fitted form of a family's best question, of length one; zero where it left nothing.
Eigen::VectorXd fitted_form(const ScoredFamily& family) {
  const Signature& s = family.signatures[family.winner().variant];
  const Eigen::MatrixXd basis = orthonormal_combinations(s, family.where());
  const Eigen::VectorXd form = s.times(basis * (basis.transpose() * s.by_residual()));
  const double length = form.norm();
  return length > 0 ? Eigen::VectorXd(form / length) : form;
}

/// Largest share, in squares, of each form (columns) inside one of the questions of a family.
Eigen::VectorXd shares_inside(const Eigen::MatrixXd& forms, const ScoredFamily& family) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(forms.cols());
  for (std::size_t v = 0; v < family.signatures.size(); ++v) {
    const Eigen::MatrixXd products = family.signatures[v].transposed_times(forms);
    for (const Score& score : family.scores) {
      if (score.variant != v) continue;
      const Eigen::MatrixXd basis = orthonormal_combinations(
          family.signatures[v], family.candidate_effect->hypotheses[score.hypothesis]);
      out = out.cwiseMax((basis.transpose() * products).colwise().squaredNorm().transpose());
    }
  }
  return out.cwiseMin(1.0);
}

}  // namespace

ConfusionMatrix confusion_of(const std::vector<ScoredFamily>& families) {
  ConfusionMatrix out;
  const auto n = static_cast<Eigen::Index>(families.size());
  out.correlation = Eigen::MatrixXd::Identity(n, n);
  out.p_right = Eigen::MatrixXd::Ones(n, n);
  if (n == 0) return out;
  Eigen::MatrixXd forms(families.front().signatures.front().rows(), n);
  for (Eigen::Index a = 0; a < n; ++a) {
    const ScoredFamily& family = families[static_cast<std::size_t>(a)];
    forms.col(a) = fitted_form(family);
    out.effects.push_back(family.candidate_effect->name);
    out.where.push_back(family.where().where);
  }
  for (Eigen::Index b = 0; b < n; ++b) {
    const Eigen::VectorXd shares = shares_inside(forms, families[static_cast<std::size_t>(b)]);
    for (Eigen::Index a = 0; a < n; ++a) {
      if (a == b) continue;
      out.correlation(a, b) = std::sqrt(shares[a]);
      out.p_right(a, b) = probability_right(kSeen * kSeen * (1 - shares[a]));
    }
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
