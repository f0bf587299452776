// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "drivers/device.h"
#include "proto/reading.h"
#include "proto/units.h"

/// These functions choose from which side the azimuth comes to a pose: backlash of the table and hysteresis
/// of the cores show only where both sides occur.
namespace mgtd::daemon::plan {

inline constexpr double kApproach_rad = to_rad(5);  ///< overshoot

[[nodiscard]] bool inside(const drivers::TableLimits& limits, const TableAngles& angles);

/// +1 upwards, -1 downwards, 0: less than 0.2 deg, no move of the azimuth.
[[nodiscard]] int sense_of(double from_rad, double to_rad);

/// `wished` or, at an end of the travel where there is room on one side only, the other one.
[[nodiscard]] int possible_sense(int wished, const TableAngles& target, const drivers::TableLimits& limits);

/// Where to go first so that the azimuth arrives at `target` in the sense wanted; none when it does anyway
/// (a table that stands there has arrived in `last_sense`), when no sense is wanted (0), or when the limits
/// leave no room.
[[nodiscard]] std::optional<TableAngles> waypoint(const TableAngles& from, int last_sense,
                                                  const TableAngles& target, int sense, double approach_rad,
                                                  const drivers::TableLimits& limits);

}  // namespace mgtd::daemon::plan
