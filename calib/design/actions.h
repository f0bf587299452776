// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "calib/sensor/sensor_model.h"
#include "proto/pose.h"

/// An Action is what could be measured on top of a run to tell two effects apart: some of its own attitudes
/// again, under other conditions.
namespace mgtd::calib::design {

inline constexpr std::size_t kActionPoses = 24;  ///< that an action adds

struct Action {
  std::string_view text;
  double extra_min;
  /// Changes pose `k` of kActionPoses; what it needs of the pose is there or left alone.
  void (*change)(Pose& pose, std::size_t k);
  double tilt_rad{0};  ///< added to the pitch of each, to either side in turn
  /// Elsewhere: effects of the site are others there, and what the site made here is not there.
  bool moved{false};
};

/// "More of the same" is the first of them.
[[nodiscard]] std::span<const Action> actions();

/// The run with the poses of an action behind it; readings stand for the attitude only, those of a new tilt
/// as `sensors` would make them.
[[nodiscard]] PoseTable extended(const PoseTable& table, const Action& action,
                                 const PerSensor<sensor::SensorModel>& sensors);

/// Temperatures at t_s, the room going on as it did over the run: a ramp that happened to end would tell time
/// and temperature apart by luck.
[[nodiscard]] PerSensor<std::optional<double>> drifted_temperatures(const PoseTable& table, double t_s);

[[nodiscard]] double minutes_per_pose(const PoseTable& table);

}  // namespace mgtd::calib::design
