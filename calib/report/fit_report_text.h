// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/fit/fit_report.h"
#include "calib/report/seen_width.h"

namespace mgtd::calib::report {

/// to_text() writes the report of a fit for a person: result and gauge, errors before and after each step,
/// the twelve parameters of every sensor with their standard deviations, the odd and even halves, every check
/// with its remedy when it failed. Fixed-width text; `width` is the number of columns that a table may have.
[[nodiscard]] std::string to_text(const fit::FitReport& report, std::size_t width = kAnyWidth);

/// The table of errors alone: a row per stage (before, simplified, step 1, after, held out, check poses).
[[nodiscard]] std::string error_table(const fit::FitReport& report, std::size_t width = kAnyWidth);
/// Whether the array determines any component of the tensor, so that there are errors of it to be shown.
[[nodiscard]] bool tells_tensor(const fit::FitReport& report);
/// What its rows are, and what none of them counts.
[[nodiscard]] std::string rows_text(const fit::FitReport& report);

}  // namespace mgtd::calib::report
