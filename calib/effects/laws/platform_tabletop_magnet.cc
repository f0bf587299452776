// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/platform_tabletop_magnet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "calib/effects/where.h"

namespace mgtd::calib::effects::laws {

TabletopMagnet::TabletopMagnet(std::vector<int> mounts, int sensors)
    : mounts_(std::move(mounts)),
      all_(static_cast<std::size_t>(sensors)),
      of_mount_(static_cast<std::size_t>(sensors)) {
  for (std::size_t m = 1; m < mounts_.size(); ++m) {
    for (int sensor = 0; sensor < sensors; ++sensor) {
      const auto s = static_cast<std::size_t>(sensor);
      for (int axis = 0; axis < 3; ++axis) {
        const auto index = static_cast<int>(coefficients_.size());
        all_[s].push_back(index);
        of_mount_[s][mounts_[m]].push_back(index);
        coefficients_.push_back({.name = fmt::format("m{}.{}", mounts_[m], axis_name(sensor, axis)),
                                 .unit = "nT",
                                 .typical = 10});
      }
    }
  }
}

std::string TabletopMagnet::spec() const {
  if (mounts_.empty()) return std::string(name());
  return fmt::format("{},mounts={}", name(), fmt::join(mounts_, "/"));
}

Result<std::shared_ptr<const Effect>> TabletopMagnet::bound(const EffectContext& context) const {
  if (!mounts_.empty() || context.table == nullptr) return std::shared_ptr<const Effect>();
  std::set<int> found;
  for (const Pose& pose : context.table->poses) {
    if (pose.mount) found.insert(*pose.mount);
  }
  if (found.size() < 2) {
    return fail(
        ErrorCode::refused,
        fmt::format("platform.tabletop-magnet: the column mount tells {} mountings of the array, needs 2",
                    found.size()),
        "turn or tilt the array on the table, measure again, and number the mountings");
  }
  return std::make_shared<const TabletopMagnet>(std::vector<int>(found.begin(), found.end()),
                                                context.sensors());
}

std::span<const int> TabletopMagnet::at(int sensor) const { return all_[static_cast<std::size_t>(sensor)]; }

std::span<const int> TabletopMagnet::active(const Conditions& at, int sensor) const {
  const auto& mounts = of_mount_[static_cast<std::size_t>(sensor)];
  const auto found = mounts.find(at.pose.mount.value_or(0));
  return found == mounts.end() ? std::span<const int>() : std::span<const int>(found->second);
}

}  // namespace mgtd::calib::effects::laws
