// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/axis_offset.h"

namespace mgtd::calib::effects::laws {

std::optional<double> middle_h(const EffectContext& context) {
  if (context.table == nullptr || context.table->poses.empty()) return std::nullopt;
  const std::vector<Pose>& poses = context.table->poses;
  return poses::RunTime::of(*context.table).hours(poses[poses.size() / 2]);
}

}  // namespace mgtd::calib::effects::laws
