// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/fit/fit_report.h"

namespace mgtd::calib::fit::checks {

/// common_checks() makes the checks that every method has to pass: scale factors, non-orthogonality, volume
/// and total field.
[[nodiscard]] std::vector<Check> common_checks(const FitReport& report);

/// Whether so many poses contradict the others that none can be trusted.
[[nodiscard]] Check bad_poses_check(const FitReport& report);

}  // namespace mgtd::calib::fit::checks
