// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/fit/joint/identifiability.h"

/// These functions say in words what the poses do not determine.
namespace mgtd::calib::fit::checks {

/// "s1 offset z with s1 scale z"
[[nodiscard]] std::string to_text(const joint::WeakDirection& weak);
/// "50 nT of field", "not at all": how well such a direction is known.
[[nodiscard]] std::string weak_sd_text(double sd_nT);
/// "seen from the rig the field stays between 20 and 90 deg from platform +Z"
[[nodiscard]] std::string to_text(const joint::FieldCoverage& coverage);
/// "azimuth 90, pitch -45, roll 0 deg"
[[nodiscard]] std::string to_text(const TableAngles& angles);
/// The same for several, with semicolons between them.
[[nodiscard]] std::string to_text(const std::vector<TableAngles>& poses);
/// Where no table turned the array: the direction of the field in the platform frame at each of these
/// attitudes, "+X; (0.00, 0.71, -0.71)", none twice.
[[nodiscard]] std::string field_directions_text(const std::vector<TableAngles>& poses);
/// What to do about them: poses for a table, directions of the field for an array that is turned by hand.
[[nodiscard]] std::string additions_text(const std::vector<TableAngles>& poses, bool table);

}  // namespace mgtd::calib::fit::checks
