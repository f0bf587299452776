// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/discovery/law_search.h"

/// These functions rank laws by their evidence, never by their chi-square or by a probability of chance: a
/// formula that can bend more falls further, and a search finds the one that bends best.
///
///     q_i     = S_i - k_i ln(1 + S_i)                              a price for each coefficient
///     2 ln E  = 2 ln( mean over i of exp(q_i / 2) )                i: values of the inner number
///     score   = 2 ln E - 2 ln(places of the kind) - 2 kappa C      C symbols, kappa 1.5
///     P       = exp(score / 2) over the sum of all
///
/// Every effect of the library stands in the same ranking. What is random is held against all laws together:
/// law_sequence.h.
namespace mgtd::calib::discovery {

inline constexpr double kSymbolPrice = 1.5;

/// q of one question.
[[nodiscard]] double price_paid(double S, int k);

struct RankedLaw {
  enum class Kind { formula, library };
  Kind kind{Kind::formula};
  std::size_t family{0};  ///< of the grammar
  std::string effect{};   ///< of the library
  Place place;
  std::string where{};  ///< name of the place
  double inner{0};      ///< the best
  int k{0}, symbols{0};
  double S{0}, score{0}, P{0};
};

/// Formulas by family and place, best first; P is zero yet.
[[nodiscard]] std::vector<RankedLaw> rank_formulas(const std::vector<Tried>& tried,
                                                   const FormulaValues& values, int channels);
/// Finds a better inner number for the first `count`, between the neighbours on the grid.
[[nodiscard]] Result<void> refine_inner(std::vector<RankedLaw>& laws, std::size_t count,
                                        const Grammar& grammar, LawInputs& inputs, const ChannelSums& sums);
/// Sorts by score and sets P.
void share_probability(std::vector<RankedLaw>& laws);

}  // namespace mgtd::calib::discovery
