// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/score.h"

#include <cmath>
#include <optional>
#include <utility>

#include "calib/linear/cholesky.h"
#include "calib/linear/parts.h"
#include "calib/linear/symmetric_eigen.h"
#include "calib/stats/f_distribution.h"

namespace mgtd::calib::criticism::tests {

double NoiseReference::log10_p(double S, int k, int axes) const {
  if (known) return stats::f_log10_p(S / k, k, nu);
  // The noise of the channels concerned is what they have left once the effect is taken out.
  const double own = by_channel ? dof * axes / channels : dof;
  if (!(own > k)) return 0;  // nothing would be left to tell the noise from
  const double left = own * chi2 / dof - S;
  if (!(left > 0)) return stats::f_log10_p(1e12, k, own - k);
  return stats::f_log10_p(S / k / (left / (own - k)), k, own - k);
}

namespace {

/// An entry of `combine` that is not zero: most are.
struct Entry {
  Eigen::Index finest, combined;
  double value;
};

std::vector<Entry> entries_of(const Eigen::MatrixXd& combine) {
  std::vector<Entry> out;
  for (Eigen::Index j = 0; j < combine.cols(); ++j)
    for (Eigen::Index i = 0; i < combine.rows(); ++i)
      if (combine(i, j) != 0) out.push_back({i, j, combine(i, j)});
  return out;
}

/// The V with V'MV = 1 that spans what of M is above `absorbed2`. Where that is all of M, by Cholesky:
/// the smallest eigenvalue is no less than 1 / |L^-1|^2.
Eigen::MatrixXd whitening_of(const Eigen::MatrixXd& M, double absorbed2) {
  if (const auto cholesky = linear::Cholesky::of_unscaled(M)) {
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(M.rows(), M.cols()),
                          inverse = cholesky->whiten(one);
    if (inverse.squaredNorm() * absorbed2 < 1) return inverse.transpose();
  }
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(M);
  const auto rank = eigen.values.size() - (eigen.values.array() < absorbed2).count();
  return eigen.vectors.rightCols(rank) * eigen.values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
}

/// Of the combined columns, the combinations that are orthonormal after projection.
Eigen::MatrixXd whitening_of(const Signature& s, const std::vector<Entry>& entries, Eigen::Index combined) {
  // Lengths of the combined columns before projection, as if those combined did not overlap.
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(combined);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(combined, combined);
  for (const Entry& a : entries) {
    squares[a.combined] += std::pow(a.value * s.norms()[a.finest], 2);
    for (const Entry& b : entries)
      M(a.combined, b.combined) += a.value * s.gram()(a.finest, b.finest) * b.value;
  }
  const Eigen::VectorXd scale = (squares.array() > 0).select(squares.cwiseSqrt().cwiseInverse(), 0.0);
  return scale.asDiagonal() *
         whitening_of(scale.asDiagonal() * M * scale.asDiagonal(), s.absorbed() * s.absorbed());
}

Eigen::MatrixXd spread(const std::vector<Entry>& entries, const Eigen::MatrixXd& V, Eigen::Index finest) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(finest, V.cols());
  for (const Entry& a : entries) out.row(a.finest) += a.value * V.row(a.combined);
  return out;
}

}  // namespace

Eigen::MatrixXd orthonormal_combinations(const Signature& s, const Hypothesis& h) {
  const std::vector<Entry> entries = entries_of(h.combine);
  return spread(entries, whitening_of(s, entries, h.combine.cols()), h.combine.rows());
}

OneStep one_step(const Signature& s, const Hypothesis& h) {
  const std::vector<Entry> entries = entries_of(h.combine);
  const Eigen::MatrixXd V = whitening_of(s, entries, h.combine.cols());
  const Eigen::MatrixXd basis = spread(entries, V, h.combine.rows());
  return {
      .value = V * (basis.transpose() * s.by_residual()), .covariance = V * V.transpose(), .basis = basis};
}

namespace {

Score score_one(const Signature& s, const Hypothesis& h) {
  Score out;
  if (h.combine.cols() > 1) {
    const Eigen::MatrixXd basis = orthonormal_combinations(s, h);
    out.k = static_cast<int>(basis.cols());
    out.S = (basis.transpose() * s.by_residual()).squaredNorm();
    return out;
  }
  const auto t = h.combine.col(0);
  const double whole = t.cwiseAbs2().dot(s.norms().cwiseAbs2()), left = t.dot(s.gram() * t);
  if (left < s.absorbed() * s.absorbed() * whole || !(left > 0)) return out;
  out.k = 1;
  out.S = std::pow(t.dot(s.by_residual()), 2) / left;
  return out;
}

}  // namespace

void ScoredFamily::score_last(const NoiseReference& noise) {
  for (std::size_t h = 0; h < candidate_effect->hypotheses.size(); ++h) {
    const Hypothesis& hypothesis = candidate_effect->hypotheses[h];
    if (hypothesis.combine.rows() != signatures.back().cols()) continue;  // of another form of the law
    Score score = score_one(signatures.back(), hypothesis);
    if (score.k == 0) continue;
    score.hypothesis = h;
    score.variant = signatures.size() - 1;
    score.log10_p = noise.log10_p(score.S, score.k, hypothesis.axes);
    const double asked_here = score.log10_p + std::log10(hypothesis.alike);
    if (scores.empty() || asked_here < priced) {
      priced = asked_here;
      best = scores.size();
    }
    scores.push_back(score);
  }
}

ScoredFamily score_family(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                          const Residual& residual, const NoiseReference& noise,
                          const CandidateEffect& candidate_effect) {
  return std::move(score_families(problem, state, residual, noise, {&candidate_effect}).front());
}

std::vector<ScoredFamily> score_families(const fit::joint::JointProblem& problem,
                                         const fit::joint::JointState& state, const Residual& residual,
                                         const NoiseReference& noise,
                                         const std::vector<const CandidateEffect*>& candidates) {
  std::vector<const effects::EffectPtr*> variants;
  for (const CandidateEffect* candidate : candidates)
    for (const effects::EffectPtr& variant : candidate->variants) variants.push_back(&variant);
  std::vector<std::optional<Signature>> signatures(variants.size());
  linear::for_each_part(variants.size(), [&](std::size_t i) {
    signatures[i].emplace(residual, effect_source(problem, state, *variants[i]));
  });
  std::vector<ScoredFamily> out;
  auto signature = signatures.begin();
  for (const CandidateEffect* candidate : candidates) {
    ScoredFamily& family = out.emplace_back(ScoredFamily{.candidate_effect = candidate});
    for (std::size_t v = 0; v < candidate->variants.size(); ++v) {
      family.signatures.push_back(*std::move(*signature++));
      family.score_last(noise);
    }
    family.calibrated = std::min(0.0, family.priced);
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
