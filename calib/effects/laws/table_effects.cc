// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/table_effects.h"

namespace mgtd::calib::effects::laws {

Result<void> Backlash::applicable(const PoseTable& table) const {
  constexpr std::size_t kOneOf = 10;
  std::size_t without = 0;
  for (const Pose& pose : table.poses) {
    if (!missing_angle(pose).empty()) return Effect::applicable(table);
    without += pose.sense ? 0U : 1U;
  }
  return kOneOf * without <= table.poses.size() ? Result<void>{} : Effect::applicable(table);
}

}  // namespace mgtd::calib::effects::laws
