// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "calib/design/hypothesis_fit.h"
#include "calib/design/law_actions.h"
#include "calib/design/next_measurement.h"

/// hypothesis_menu() finds which further measurement would tell apart several formulas or effects that could
/// each account for the same residual.
///
/// Each has the coefficients that fit the residual of the run best (one linearisation of the joint fit, as in
/// calib/discovery). Of two, the one that leaves less is taken as true, and
///     lambda_ab = |(I - P_b) z_a gamma_a|^2
/// is computed on the run with the poses of each action behind it (hypothesis_distance.h). Pairs that no
/// action tells apart are told and set aside. Each other pair counts by the product of its probabilities,
/// P_a P_b: the right one of two is named with
///     p = sum P_a P_b Phi(sqrt(lambda_ab) / 2) / sum P_a P_b.
/// Where an action leaves the attitudes open, those are taken that set the pair that is most open apart most
/// a minute, one pose after the other. Actions are ranked by what they add to p a minute.
namespace mgtd::calib::design {

struct HypothesisStep {
  NextMeasurement measurement;
  std::vector<Pose> poses;
  bool by_the_rig{false}, other_day{false};
};

/// An action that the columns of a run cannot express.
struct LeftOut {
  std::string action, why;
};

struct HypothesisMenu {
  HypothesisFit hypotheses;
  HypothesisPair worst;     ///< most open on the run, of those that something tells apart
  double lambda_before{0};  ///< of that pair; so in the steps
  double p_right_before{1};
  std::vector<HypothesisStep> steps;  ///< best first; what adds nothing is no step
  std::vector<LeftOut> left_out;
  std::vector<HypothesisPair> never;  ///< pairs that the run does not tell apart, and no action either
};

/// `fit`: of a model without the hypotheses. Refuses fewer than two hypotheses, and what hypothesis_fit()
/// refuses.
[[nodiscard]] Result<HypothesisMenu> hypothesis_menu(const PoseTable& run, const fit::joint::JointFit& fit,
                                                     const fit::joint::JointOptions& options,
                                                     const std::vector<Hypothesis>& hypotheses,
                                                     std::uint64_t seed,
                                                     std::span<const LawAction> actions = law_actions());

}  // namespace mgtd::calib::design
