// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "proto/reading.h"

namespace mgtd::daemon::run {

/// angles_text() writes angles as "azimuth 90.00, pitch -45.00, roll 0.00 deg": to a hundredth of a degree,
/// zero without a sign.
[[nodiscard]] std::string angles_text(const TableAngles& angles);

}  // namespace mgtd::daemon::run
