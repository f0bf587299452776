// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/platform_current.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "calib/effects/effect_spec.h"

namespace mgtd::calib::effects::laws {
namespace {

std::vector<std::string> names_of(const std::vector<std::string>& columns) {
  std::vector<std::string> out;
  for (const std::string& column : columns) {
    for (const char axis : {'x', 'y', 'z'}) out.push_back(fmt::format("{}.{}", column, axis));
  }
  return out;
}

}  // namespace

std::vector<std::string> current_columns(const PoseTable& table) {
  std::set<std::string> found;
  for (const Pose& pose : table.poses) {
    for (const auto& [name, value] : pose.covariates) {
      if (name.size() > 2 && name.ends_with("_A")) found.insert(name);
    }
  }
  return {found.begin(), found.end()};
}

PlatformCurrent::PlatformCurrent(std::vector<std::string> columns, const Where& where)
    : PlatformEffect({names_of(columns), "nT/A", 20, where}), columns_(std::move(columns)) {}

std::string PlatformCurrent::spec() const {
  std::string out = PlatformEffect::spec();
  if (!columns_.empty()) out += fmt::format(",columns={}", fmt::join(columns_, "/"));
  return out;
}

Result<std::shared_ptr<const Effect>> PlatformCurrent::bound(const EffectContext& context) const {
  if (!columns_.empty() || context.table == nullptr) return std::shared_ptr<const Effect>();
  std::vector<std::string> columns = current_columns(*context.table);
  if (columns.empty()) {
    return fail(ErrorCode::refused, "platform.current: no column of the poses ends in _A",
                "record the currents that flow near the array, in ampere, one column each (motor_A)");
  }
  if (columns.size() > kMaxColumns) {
    return fail(ErrorCode::refused,
                fmt::format("platform.current: {} columns end in _A, at most {} at once", columns.size(),
                            kMaxColumns),
                fmt::format("name them: platform.current,columns={}", fmt::join(columns, "/")));
  }
  return std::make_shared<const PlatformCurrent>(std::move(columns), scale().where());
}

std::string_view PlatformCurrent::missing(const Pose& pose) const {
  for (const std::string& column : columns_) {
    if (!pose.covariates.contains(column)) return column;
  }
  return {};
}

Result<void> PlatformCurrent::applicable(const PoseTable& table) const {
  if (auto ok = Effect::applicable(table); !ok) return ok;
  for (const std::string& column : columns_) {
    const double first = table.poses.front().covariates.at(column);
    const bool moves = std::any_of(table.poses.begin(), table.poses.end(),
                                   [&](const Pose& pose) { return pose.covariates.at(column) != first; });
    if (moves) continue;
    return fail(
        ErrorCode::refused,
        fmt::format("platform.current: {} is {:g} A at every pose; the field of a constant current is "
                    "part of the offsets",
                    column, first),
        "switch the current on and off between poses");
  }
  return {};
}

double PlatformCurrent::above_mean_A(const Conditions& at, const std::string& column) {
  const double current = at.pose.covariates.at(column);
  if (at.means == nullptr) return current;
  const auto mean = at.means->find(column);
  return mean == at.means->end() ? current : current - mean->second;
}

}  // namespace mgtd::calib::effects::laws
