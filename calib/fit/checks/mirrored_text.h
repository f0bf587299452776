// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace mgtd::calib::fit::checks {

/// Says which sensors, by number, are mirrored and what that means.
[[nodiscard]] std::string mirrored_text(const std::vector<std::size_t>& sensors);

}  // namespace mgtd::calib::fit::checks
