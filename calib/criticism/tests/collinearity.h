// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/tests/added_variable.h"
#include "calib/criticism/tests/candidate_effect.h"
#include "calib/fit/method_choice/fit.h"

/// examine_formula() examines a user's formula on a run before it is used: how much of it the calibration
/// absorbs, how large it would have to be to be seen, and with which known effects it is collinear.
namespace mgtd::calib::criticism::tests {

struct Collinearity {
  std::string effect{};
  double correlation{0};  ///< of the formula with the best combination of the effect's coefficients
};

/// Correlation above which no run like this can tell two effects apart.
inline constexpr double kTheSame = 0.98;

struct FormulaExamination {
  std::string name{}, where{}, expression{};
  double absorbed{0};  ///< share of its signature, in squares, that calibration, attitude and field take up
  int k{0}, rank{0};   ///< coefficients, and how many of them the poses can tell
  double S{0}, log10_p{0};  ///< score test of this question alone, on this run
  std::vector<calibration::EffectCoefficient> coefficients{};
  double detectable{0};  ///< smallest value of its worst coefficient that is seen in 99 of 100 runs like this
  std::string unit{};
  std::vector<Collinearity> alike{};  ///< strongest first; at most five
  AddedVariable signature{};          ///< by pose, before it is in any model

  [[nodiscard]] bool wholly_absorbed() const { return rank == 0; }
  [[nodiscard]] double d() const;
};

/// `formula` on top of the model of `options`. Refuses what a fit refuses, and derivatives that are no
/// derivatives (derivative_check.h).
[[nodiscard]] Result<FormulaExamination> examine_formula(const PoseTable& table,
                                                         const fit::FitOptions& options,
                                                         const effects::EffectSpec& formula);

/// A formula as one of the candidates of explain(), at the scale it was given.
[[nodiscard]] Result<CandidateEffect> formula_candidate(const effects::EffectSpec& formula, int sensors);

}  // namespace mgtd::calib::criticism::tests
