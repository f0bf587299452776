// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/run_time.h"

#include <algorithm>

namespace mgtd::calib::poses {

RunTime RunTime::of(const PoseTable& table) {
  const auto first =
      std::find_if(table.poses.begin(), table.poses.end(), [](const Pose& p) { return p.t_utc.has_value(); });
  if (first == table.poses.end()) return {};
  return {WallTime{first->t_utc->ns - from_seconds(first->t_s.value_or(0)).count()}};
}

double RunTime::hours(const Pose& pose) const {
  if (start && pose.t_utc) return to_seconds(Duration{pose.t_utc->ns - start->ns}) / 3600;
  return pose.t_s.value_or(0) / 3600;
}

}  // namespace mgtd::calib::poses
