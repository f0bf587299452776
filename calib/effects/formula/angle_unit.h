// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "proto/error.h"

/// check_angles() finds degrees where an expression expects radians. The columns that end in `_deg` are in
/// degrees; sin, cos and tan of an expression take radians. sin(azimuth_deg) is nearly always a slip, and
/// fits as noise.
namespace mgtd::calib::effects::formula {

/// Refuses a sin, cos or tan whose argument has such a column and no conversion (pi, 0.01745 or 57.29), and
/// says how each meaning is written. Errors: `usage`.
[[nodiscard]] Result<void> check_angles(std::string_view expression);

}  // namespace mgtd::calib::effects::formula
