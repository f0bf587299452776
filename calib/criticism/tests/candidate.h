// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/tests/alternatives.h"
#include "calib/criticism/tests/criticism.h"
#include "calib/fit/joint/effect_impact.h"

/// A Candidate is an effect that the model may lack, as reports show it: with its size, its share of the
/// excess, what else could stand in its place and the poses that carry its evidence.
namespace mgtd::calib::criticism::tests {

struct Candidate {
  std::string effect{}, where{};
  std::string spec{};  ///< as --with reads it
  int k{0};
  double log10_p{0};  ///< of the family, calibrated
  double d{0};        ///< sqrt(max(0, S - k)): its size in units of its own uncertainty
  double fall{0};     ///< S, predicted fall of chi-square
  double share{0};    ///< of the excess of chi-square over its degrees of freedom
  std::vector<calibration::EffectCoefficient> coefficients{};
  std::vector<Alternative> alternatives{};
  bool plausible{true};
  std::vector<int> poses{};  ///< numbers of those that carry half of the evidence
  double largest_pose{0};    ///< share of the one that carries most
  /// What a model without it does to the tensor, if it is there as it was fitted; empty where nobody asked.
  std::optional<fit::joint::EffectImpact> impact{};
};

/// `noise_inflation`: of the fit that was judged (JointFit::noise_inflation), so that the fall of chi-square
/// is in units of the noise that the readings tell.
[[nodiscard]] Candidate candidate_of(const ScoredFamily& family, const Criticism& criticism,
                                     double noise_inflation);

/// Fills in the poses that carry half of the evidence, the heaviest first; `by_pose` by place in the fit.
void weigh_poses(const fit::joint::JointFit& fit, const std::vector<double>& by_pose, Candidate& out);

/// Candidate::impact, of the winner of a family.
[[nodiscard]] std::optional<fit::joint::EffectImpact> impact_of(const fit::joint::JointFit& fit,
                                                                const ScoredFamily& family);

/// The coefficient that stands out most from its uncertainty; null where there is none.
[[nodiscard]] const calibration::EffectCoefficient* seen_most(const Candidate& candidate);

/// Where a coefficient acts: "s2.z" of "s2.z" and of "s2.z.squares", "s2" of "s2".
[[nodiscard]] std::string place_of(const calibration::EffectCoefficient& coefficient);

}  // namespace mgtd::calib::criticism::tests
