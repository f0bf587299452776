// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/identifiability.h"
#include "calib/fit/verdict.h"

namespace mgtd::calib {

/// Checks of a joint fit: the common ones, that the poses determine every parameter, that no sensor stands
/// between two mountings, that the table's angles are what they say, that the bad poses are few, and that a
/// given inclination and declination are those of the data.
[[nodiscard]] std::vector<Check> joint_verdict(const FitReport& report, const Identifiability& known,
                                               const FitOptions& options);

/// What was recognised: turned sensors, residual, outlier nodes, weak directions and the poses that would
/// help.
[[nodiscard]] std::vector<std::string> joint_remarks(const FitReport& report, const Identifiability& known,
                                                     double spread);

}  // namespace mgtd::calib
