// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/discovery/chosen_law.h"

/// The laws of a run, one after the other: each is taken out of the residual, and the search is repeated in
/// what is left, until nothing stands out. Then each is looked for again beside the others, because two laws
/// on one axis first show as a compromise.
///
/// Random rivals are held against all laws together. With T_m the evidence of the first m laws and R_m that
/// of an offset that walks or jumps in what they leave, the best of T_m (laws alone) is compared with the
/// best of T_m + R_m: one law of two would lose to jumps, which take up the other one too.
namespace mgtd::calib::discovery {

inline constexpr std::size_t kMostLaws = 3;

struct LawSequence {
  std::vector<ChosenLaw> laws{};  ///< strongest first; the first one even where it is not significant
  std::size_t hypotheses{0};      ///< of the first search
  double log10_p_left{0};         ///< of the search in what the laws leave
  ChannelSums left;               ///< what they leave
};

[[nodiscard]] Result<LawSequence> law_sequence(const Workbench& bench, const ChannelSums& bare,
                                               double questions);

}  // namespace mgtd::calib::discovery
