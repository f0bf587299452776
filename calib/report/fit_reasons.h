// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/fit/fit_report.h"

/// fit_reasons() says what the operator must know about a fit, one sentence each.
namespace mgtd::calib::report {

/// What the caller found beside the fit, each failed check with its limit and remedy, then what was
/// recognised: turned and mirrored sensors, lack of fit, readings that are left out, what the poses do not
/// determine.
[[nodiscard]] std::vector<std::string> fit_reasons(const fit::FitReport& report);

/// Residual against noise, where the model does not explain the data down to the noise; else empty.
[[nodiscard]] std::string lack_of_fit_text(const fit::FitReport& report);

/// Combinations of parameters that the poses determine badly, with what that leaves in the field; of a joint
/// fit.
[[nodiscard]] std::vector<std::string> weak_texts(const fit::FitReport& report);

/// The sentence on table angles that are several times less accurate than was stated (table_is_rough).
[[nodiscard]] std::string rough_table_text(double estimated_rad, double stated_rad);

}  // namespace mgtd::calib::report
