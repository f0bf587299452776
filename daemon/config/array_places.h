// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/sensor/geometry.h"
#include "drivers/settings.h"
#include "proto/error.h"

/// The section [array] says where the sensors of an array stand, as the operator writes it, in the platform
/// frame, metres, in the order s1, s2, ...:
///
///     [array]
///     positions_m = [[0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]]
///
/// The same section stands in a configuration and in the file that `--array` names.
namespace mgtd::daemon::config {

/// Empty where the section is not there or is wrong; every mistake is appended with its place: another key,
/// not 1 to kMostSensors places, a place without three finite numbers within kFarthest_m, two at the same
/// place.
[[nodiscard]] std::optional<calib::sensor::Geometry> read_array(const toml::table& root,
                                                                std::vector<drivers::SettingError>& mistakes);

inline constexpr double kFarthest_m = 100;  ///< from the origin, along each axis

/// The array that `text` describes; other sections are not looked at, so that a configuration serves too.
/// Refuses, with file:line:column, what is not TOML, what read_array finds, and a file without [array].
[[nodiscard]] Result<calib::sensor::Geometry> array_from_text(std::string_view text, const std::string& file);

}  // namespace mgtd::daemon::config
