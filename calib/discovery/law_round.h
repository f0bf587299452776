// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "calib/criticism/tests/criticism.h"
#include "calib/discovery/discovery_report.h"
#include "calib/discovery/law_search.h"

/// law_round() makes one round of the search: it scores every formula against what is left and ranks the one
/// that leads beside its alternatives.
namespace mgtd::calib::discovery {

/// Chance of a formula where nothing is there, of the whole search.
inline constexpr double kFalseDiscovery = 0.01;
/// log10 of the chance that each of so many looks at a growing run has, so that all of them have that.
[[nodiscard]] double limit_log10_p(int looks);
/// The whole search finds as much in noise less often than that.
[[nodiscard]] bool stands_out(double log10_p, int looks);

/// What a search works with, from the first round to the last.
struct Workbench {
  const Grammar& grammar;
  LawInputs& inputs;
  const FormulaProducts& products;  ///< of the first residual
  const fit::joint::JointProblem& problem;
  const criticism::tests::Residual& residual;
  criticism::tests::NoiseReference noise;
  std::vector<criticism::tests::ScoredFamily>
      library{};  ///< scored on the residual, where nothing else is said
  int looks{1};   ///< DiscoverOptions
};

/// What the search of one residual says.
struct LawRound {
  double log10_p_best{0};  ///< of the best question, places of its kind priced
  std::size_t hypotheses{0};
  std::vector<RankedLaw> ranked{};  ///< with P; the library beside the formulas
  RankedLaw head{};                 ///< the best formula
  double score{0};                  ///< 2 ln of the evidence of all of them, prices paid
  double walk{0}, jumps{0};         ///< the same of an offset that walks or jumps, where the head acts
  std::string random_where{};       ///< of the better one
};

/// Refuses inputs that no formula can be tried on, and ends soon after the fit's stop token says so.
[[nodiscard]] Result<LawRound> law_round(const Workbench& bench, const ChannelSums& sums, bool with_library);
/// Effects of the library, place by place, in the order of the library; P is zero yet.
[[nodiscard]] std::vector<RankedLaw> rank_library(const std::vector<criticism::tests::ScoredFamily>& library);
/// log10 of the best question of draws of noise, by draw.
[[nodiscard]] std::vector<double> best_of_noise(const LawSearch& search, const ChannelSums& sums,
                                                const criticism::tests::NoiseReference& noise, int draws,
                                                std::uint64_t seed);

}  // namespace mgtd::calib::discovery
