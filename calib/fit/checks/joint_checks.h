// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/fit/fit_report.h"

namespace mgtd::calib::fit::checks {

/// joint_checks() makes the checks of a joint fit: the common ones, that the poses determine every parameter,
/// that no sensor stands between two mountings, that the table's angles are what they say, that the bad poses
/// are few, that a given inclination and declination are those of the data, and that the readings that were
/// kept agree.
[[nodiscard]] std::vector<Check> joint_checks(const FitReport& report, const FitOptions& options);

}  // namespace mgtd::calib::fit::checks
