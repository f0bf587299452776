// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace mgtd::calib::fit::checks {

/// Of an array of `sensors`, those of the lesser number are called mirrored; where they are half of it, the
/// field does not tell which half is.
[[nodiscard]] bool handedness_is_open(std::size_t mirrored, std::size_t sensors);

/// Says which sensors, by number, are mirrored and what that means.
[[nodiscard]] std::string mirrored_text(const std::vector<std::size_t>& mirrored, std::size_t sensors);

}  // namespace mgtd::calib::fit::checks
