// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace mgtd::calib::fit::checks {

/// The smaller group of the `sensors` is called mirrored; with two equal groups the field cannot tell
/// which.
[[nodiscard]] bool handedness_is_open(std::size_t mirrored, std::size_t sensors);

/// Says which sensors, by number, are mirrored and what that means.
[[nodiscard]] std::string mirrored_text(const std::vector<std::size_t>& mirrored, std::size_t sensors);

}  // namespace mgtd::calib::fit::checks
