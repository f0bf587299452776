// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/discovery/chosen_law.h"

/// A LawSequence holds the laws of a run, found one after the other: each is taken out of the residual, and
/// the search is repeated in what is left, until nothing stands out. Then each is looked for again beside the
/// others, because two laws on one axis first show as a compromise.
///
/// Random offsets are held against all laws together. T_m is the evidence of the first m laws, R_m that of an
/// offset that walks or jumps in what they leave; the models are T_m (laws alone) and T_m + R_m (both).
///
/// Instead of law i: its formulas stand in every model of i laws or more, an offset in their place in those
/// of fewer. 2 ln of the odds of the law is the best of the former less the best T_m + R_m of the latter, and
/// the probabilities of its formulas share what the former have of all. An offset in what all laws leave says
/// nothing against their formulas. One law of two must not stand alone here: it would lose to jumps, which
/// take up the other one too.
///
/// Beside the laws: the best T_m + R_m with laws in it is better than every T_m.
namespace mgtd::calib::discovery {

inline constexpr std::size_t kMostLaws = 3;

struct LawSequence {
  std::vector<ChosenLaw> laws{};  ///< strongest first; the first one even where it is not significant
  std::size_t hypotheses{0};      ///< of the first search
  double log10_p_left{0};         ///< of the search in what the laws leave
  ChannelSums left;               ///< what they leave
};

/// `of_gradient`: gradient_rows().
[[nodiscard]] Result<LawSequence> law_sequence(const Workbench& bench, const ChannelSums& bare,
                                               const Eigen::MatrixXd& of_gradient, double questions);

}  // namespace mgtd::calib::discovery
