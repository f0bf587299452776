// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/tests/criticism.h"
#include "calib/criticism/verdict/explain_report.h"

/// A scored family as it is told: its size, its share and the poses that speak for it.
namespace mgtd::calib {

/// `worse`: of the fit that was judged (JointFit::worse), so that the fall of chi-square is in units of the
/// noise that the readings tell.
[[nodiscard]] Candidate candidate_of(const ScoredFamily& family, const Criticism& criticism, double worse);

/// Fills in the poses that carry half of the evidence, the heaviest first; `by_pose` by place in the fit.
void weigh_poses(const JointFit& fit, const std::vector<double>& by_pose, Candidate& out);

/// The coefficient that stands out most from its uncertainty; null where there is none.
[[nodiscard]] const EffectCoefficient* seen_most(const Candidate& candidate);

/// Where a coefficient acts: "s2.z" of "s2.z" and of "s2.z.squares", "s2" of "s2".
[[nodiscard]] std::string place_of(const EffectCoefficient& coefficient);

/// "+0.42 +- 0.03 nT/degC", for several coefficients the largest against its uncertainty.
[[nodiscard]] std::string size_text(const Candidate& candidate);

}  // namespace mgtd::calib
