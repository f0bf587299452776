// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/discovery/discovery_report.h"
#include "calib/discovery/law_round.h"

/// A ChosenLaw is the outcome of one round of the search as it is reported, with the fitted formulas behind
/// it.
namespace mgtd::calib::discovery {

struct ChosenLaw {
  FoundLaw law;
  FittedLaw head;              ///< the formula that leads
  double score{0};             ///< of it, as law_ranking.h gives it
  std::vector<FittedLaw> set;  ///< formulas of the 99 % set at the place of the head, the head first
  std::vector<std::string> covariates{};  ///< of the head, as formulas name them
  std::vector<FittedLaw> alike{};         ///< of the set, those of the same covariates
};

/// `questions`: independent ones of the whole search. `name`: of the effects that the formulas become.
[[nodiscard]] Result<ChosenLaw> chosen_law(const Workbench& bench, const ChannelSums& sums,
                                           const LawRound& round, double questions, const std::string& name);

}  // namespace mgtd::calib::discovery
