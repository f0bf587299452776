// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/score.h"

#include <cmath>

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

Signature signature_of(const Residual& residual, const Eigen::MatrixXd& rows) {
  auto columns = residual.project(rows);
  Signature out{.columns = std::move(columns.projected),
                .norms = std::move(columns.norms),
                .gram = {},
                .by_residual = {},
                .absorbed = residual.absorbed()};
  const Eigen::Index m = out.columns.cols();
  out.gram = Eigen::MatrixXd::Zero(m, m);
  out.gram.selfadjointView<Eigen::Lower>().rankUpdate(out.columns.transpose());
  out.gram.triangularView<Eigen::StrictlyUpper>() = out.gram.transpose();
  out.by_residual = out.columns.transpose() * residual.value();
  return out;
}

OneStep one_step(const Signature& s, const Hypothesis& h) {
  const Eigen::MatrixXd& T = h.combine;
  // Lengths of the combined columns before projection, as if those combined did not overlap.
  const Eigen::VectorXd length = (T.cwiseAbs2().transpose() * s.norms.cwiseAbs2()).cwiseSqrt();
  const Eigen::VectorXd scale = (length.array() > 0).select(length.cwiseInverse(), 0.0);
  const Eigen::MatrixXd M = scale.asDiagonal() * (T.transpose() * s.gram * T) * scale.asDiagonal();
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(M);
  const Eigen::VectorXd& values = eigen.values;
  const auto absorbed = (values.array() < s.absorbed * s.absorbed).count();
  const Eigen::Index rank = values.size() - absorbed;
  const Eigen::MatrixXd V = scale.asDiagonal() * eigen.vectors.rightCols(rank) *
                            values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen::MatrixXd basis = T * V;
  return {.value = V * (basis.transpose() * s.by_residual), .covariance = V * V.transpose(), .basis = basis};
}

namespace {

Score score_one(const Signature& s, const Hypothesis& h) {
  Score out;
  if (h.combine.cols() > 1) {
    const OneStep step = one_step(s, h);
    out.k = static_cast<int>(step.basis.cols());
    out.S = (step.basis.transpose() * s.by_residual).squaredNorm();
    return out;
  }
  const auto t = h.combine.col(0);
  const double whole = t.cwiseAbs2().dot(s.norms.cwiseAbs2()), left = t.dot(s.gram * t);
  if (left < s.absorbed * s.absorbed * whole || !(left > 0)) return out;
  out.k = 1;
  out.S = std::pow(t.dot(s.by_residual), 2) / left;
  return out;
}

}  // namespace

void ScoredFamily::score_last(const NoiseReference& noise) {
  for (std::size_t h = 0; h < candidate_effect->hypotheses.size(); ++h) {
    const Hypothesis& hypothesis = candidate_effect->hypotheses[h];
    if (hypothesis.combine.rows() != signatures.back().columns.cols())
      continue;  // of another form of the law
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
  ScoredFamily out{.candidate_effect = &candidate_effect};
  for (const effects::EffectPtr& variant : candidate_effect.variants) {
    out.signatures.push_back(signature_of(residual, effect_rows(problem, state, variant)));
    out.score_last(noise);
  }
  out.calibrated = std::min(0.0, out.priced);
  return out;
}

}  // namespace mgtd::calib::criticism::tests
