// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/effect.h"

#include <fmt/format.h>

namespace mgtd::calib::effects {

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

std::string Lack::text(std::string_view effect, const PoseTable& table) const {
  const std::string who = poses == table.poses.size() ? std::string("no pose has")
                          : poses == 1 ? fmt::format("pose {} of {} has not", first, table.poses.size())
                                       : fmt::format("{} of {} poses have not (the first: pose {})", poses,
                                                     table.poses.size(), first);
  return fmt::format("{} needs {}, which {}", effect, column, who);
}

Lack Effect::lack_of(const PoseTable& table) const {
  Lack out;
  for (const Pose& pose : table.poses) {
    const std::string_view column = missing(pose);
    if (column.empty()) continue;
    if (out.poses == 0) out.column = column, out.first = pose.number;
    if (column == out.column) ++out.poses;
  }
  return out;
}

Result<void> Effect::applicable(const PoseTable& table) const {
  const Lack lack = lack_of(table);
  if (lack.poses == 0) return {};
  return fail(
      ErrorCode::refused, lack.text(name(), table),
      fmt::format("give {0} of every pose, leave the poses without it out of the table, or fit without {1}",
                  lack.column, name()));
}

std::vector<std::string> specs_of(std::span<const EffectPtr> effects) {
  std::vector<std::string> out;
  for (const EffectPtr& effect : effects) out.push_back(effect->spec());
  return out;
}

CovariateMeans covariate_means(const PoseTable& table) {
  CovariateMeans sum, count;
  for (const Pose& pose : table.poses) {
    if (pose.set == "check") continue;
    for (const auto& [name, value] : pose.covariates) sum[name] += value, ++count[name];
  }
  for (auto& [name, mean] : sum) mean /= count[name];
  return sum;
}

}  // namespace mgtd::calib::effects
