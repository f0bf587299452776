// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"

/// law_figure() draws the curve of a law over what it depends on, found without a formula, and the formulas
/// that could be it.
namespace mgtd::calib::report::figures {

struct LawFormulaValues {
  std::string name{};
  std::vector<double> y_nT{};  ///< at the curve's x, in its gauge
};

struct LawValues {
  std::string name{"law"};  ///< of the figure
  std::string x_label{}, where{};
  bool of_gain{false};  ///< nT at a reading of 50 000 nT
  std::vector<double> x{}, y_nT{}, sd_nT{};
  double simultaneous{1.96};                 ///< in sd: the whole curve is inside with 95 %
  std::vector<LawFormulaValues> formulas{};  ///< best first
};

/// Draws the first kMostFormulas of them.
[[nodiscard]] Figure law_figure(const LawValues& values);
inline constexpr std::size_t kMostFormulas = 4;

}  // namespace mgtd::calib::report::figures
