// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/identifiability.h"
#include "calib/fit/verdict.h"

namespace mgtd::calib {

/// How far, rms, the sensors may put the attitudes from the table's angles: a few times what the operator
/// says of them.
[[nodiscard]] double table_limit_rad(double table_sd_rad);
/// Which sensors are mirrored, by number, and what that means.
[[nodiscard]] std::string mirrored_text(const std::vector<std::size_t>& sensors);

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
