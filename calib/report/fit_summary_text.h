// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "calib/fit/fit_summary.h"

/// These functions say in words how a fit ended.
namespace mgtd::calib::report {

/// The value of "termination" in `mgt fit --json`: "closed-form", "converged", "slow-progress",
/// "round-limit".
[[nodiscard]] std::string_view to_string(fit::Termination termination);

/// "converged in 3 rounds, 17 steps: chi-square fell from 8.2e+06 to 612"
[[nodiscard]] std::string to_text(const fit::FitSummary& summary);

}  // namespace mgtd::calib::report
