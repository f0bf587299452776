// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/joint/identifiability.h"
#include "calib/fit/two_step/verdict.h"

namespace mgtd::calib {

/// How far, rms, the sensors may put the attitudes from the table's angles: what scales read by hand reach
/// when they are read badly, or a few times what the operator says of them. The fit estimates how good the
/// angles are, so that only a wrong sense or order has to be refused.
[[nodiscard]] double table_limit_rad(double table_sd_rad);
/// What to say of a table that is several times worse than was told; empty where it is not.
[[nodiscard]] std::string rough_table_text(double estimated_rad, double told_rad);
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
