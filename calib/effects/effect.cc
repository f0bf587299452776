// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/effect.h"

#include <fmt/format.h>

namespace mgtd::calib {

std::string_view to_string(Level level) {
  switch (level) {
    case Level::site:
      return "site";
    case Level::table:
      return "table";
    case Level::platform:
      return "platform";
    case Level::axis:
      return "axis";
    case Level::reference:
      return "reference";
  }
  return "";
}

std::string_view missing_angle(const Pose& pose) {
  if (!pose.azimuth_rad) return "azimuth_deg";
  if (!pose.pitch_rad) return "pitch_deg";
  return pose.roll_rad ? "" : "roll_deg";
}

Result<void> Effect::check(const PoseTable& table) const {
  for (const Pose& pose : table.poses) {
    const std::string_view column = missing(pose);
    if (column.empty()) continue;
    return fail(ErrorCode::refused,
                fmt::format("{} needs {}, which pose {} has not", name(), column, pose.number),
                fmt::format("give {} of every pose, or fit without {}", column, name()));
  }
  return {};
}

}  // namespace mgtd::calib
