// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/fit/fit_report.h"

namespace mgtd::calib::fit::checks {

/// two_step_checks() makes the checks of a two-step calibration: the common ones, that the table's angles
/// agree with the field that the sensors saw, that a given inclination is that of the data, and that both
/// halves of the standard set agree.
[[nodiscard]] std::vector<Check> two_step_checks(const FitReport& report, const FitOptions& options);

}  // namespace mgtd::calib::fit::checks
