// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/criticism/tests/collinearity.h"
#include "calib/report/figures/figure.h"

/// formula_figure() draws what a user's formula would do at each pose against what the model leaves there,
/// before the formula is in any model.
namespace mgtd::calib::report {

[[nodiscard]] figures::Figure formula_figure(const criticism::tests::FormulaExamination& x);

}  // namespace mgtd::calib::report
