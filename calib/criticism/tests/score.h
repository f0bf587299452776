// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/criticism/tests/residual.h"
#include "calib/criticism/tests/signature.h"

/// The score (Lagrange multiplier) test says whether an effect that is not in the model would improve it.
/// With z the projected columns of an effect and r the residual,
///     S = |U' r|^2, U an orthonormal basis of span(z), rank k
/// is the fall of chi-square that adding the effect would bring, chi-square distributed with k degrees of
/// freedom when it is absent. No refit. One-step coefficients are (z'z)^-1 z'r with covariance (z'z)^-1, the
/// Cramer-Rao bound with calibration and nuisances free.
namespace mgtd::calib::criticism::tests {

/// How S becomes a probability.
struct NoiseReference {
  bool known{true};       ///< the noise is known from the dwells; else it is that of the residual itself, ...
  bool by_channel{true};  ///< ... channel by channel
  int channels{sensor::kChannels};
  double scale2{1};  ///< variance of the noise over that of the weights, where the dwells say too little
  double nu{std::numeric_limits<double>::infinity()};  ///< degrees of freedom behind scale2
  double chi2{0}, dof{0};                              ///< of the residual in units of this noise
  /// The dwells say how large the noise is, and nothing contradicts them.
  [[nodiscard]] bool from_dwells() const { return known && std::isinf(nu); }
  /// log10 of the probability that an absent effect on `axes` channels gives a fall of S or more.
  [[nodiscard]] double log10_p(double S, int k, int axes) const;
};

struct Score {
  std::size_t hypothesis{0}, variant{0};
  double S{0};
  int k{0};
  double log10_p{0};  ///< of this one question
  [[nodiscard]] double d() const { return std::sqrt(std::max(0.0, S - k)); }
};

/// Coefficients of one hypothesis. `basis` maps the finest columns to orthonormal ones.
struct OneStep {
  Eigen::VectorXd value{};
  Eigen::MatrixXd covariance{};
  Eigen::MatrixXd basis{};  ///< finest x k
};

struct ScoredFamily {
  const CandidateEffect* candidate_effect{nullptr};
  std::shared_ptr<const CandidateEffect>
      own{};                            ///< that candidate, where it was refined: see scan_refinement.h
  std::vector<Signature> signatures{};  ///< by variant
  std::vector<Score> scores{};          ///< every hypothesis that has a rank, every variant
  std::size_t best{0};
  double priced{0};      ///< log10 p of the best question times `alike`
  double asked{1};       ///< independent questions in the family, by draws: see multiplicity.h
  double calibrated{0};  ///< log10 p of the family, that many questions counted
  [[nodiscard]] const Score& winner() const { return scores[best]; }
  [[nodiscard]] const Hypothesis& where() const { return candidate_effect->hypotheses[winner().hypothesis]; }
  [[nodiscard]] bool testable() const { return !scores.empty(); }
  /// Scores every hypothesis of the signature added last.
  void score_last(const NoiseReference& noise);
};

[[nodiscard]] OneStep one_step(const Signature& signature, const Hypothesis& hypothesis);
/// The basis of that step alone.
[[nodiscard]] Eigen::MatrixXd orthonormal_combinations(const Signature& signature,
                                                       const Hypothesis& hypothesis);
[[nodiscard]] ScoredFamily score_family(const fit::joint::JointProblem& problem,
                                        const fit::joint::JointState& state, const Residual& residual,
                                        const NoiseReference& noise, const CandidateEffect& candidate_effect);
/// The same of several, in their order.
[[nodiscard]] std::vector<ScoredFamily> score_families(const fit::joint::JointProblem& problem,
                                                       const fit::joint::JointState& state,
                                                       const Residual& residual, const NoiseReference& noise,
                                                       const std::vector<const CandidateEffect*>& candidates);

}  // namespace mgtd::calib::criticism::tests
