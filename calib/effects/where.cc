// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/where.h"

#include <fmt/format.h>

#include "proto/reading.h"

namespace mgtd::calib::effects {

std::string sensor_name(int sensor) { return fmt::format("s{}", sensor + 1); }
std::string axis_name(int sensor, int axis) { return fmt::format("s{}.{}", sensor + 1, "xyz"[axis]); }

Result<Where> Where::parse(std::string_view text) {
  if (text == "all") return Where{.scale = Scale::all};
  if (text == "each-sensor") return Where{.scale = Scale::each_sensor};
  if (text == "each-axis") return Where{.scale = Scale::each_axis};
  if (text == "site" || text == "platform" || text == "table") return Where{.scale = Scale::own};
  for (int sensor = 0; sensor < kMostSensors; ++sensor) {
    if (text == sensor_name(sensor)) return Where{.scale = Scale::sensor, .sensor = sensor};
    for (int axis = 0; axis < 3; ++axis) {
      if (text == axis_name(sensor, axis)) return Where{.scale = Scale::axis, .sensor = sensor, .axis = axis};
    }
  }
  return fail(ErrorCode::usage, fmt::format("'{}' is no place for an effect", text),
              "all, each-sensor, each-axis, a sensor (s1, s2, ...) or an axis (s1.x, s1.y, ...)");
}

std::string Where::text() const {
  switch (scale) {
    case Scale::all:
      return "all";
    case Scale::each_sensor:
      return "each-sensor";
    case Scale::each_axis:
      return "each-axis";
    case Scale::sensor:
      return sensor_name(sensor);
    case Scale::axis:
      return axis_name(sensor, axis);
    case Scale::own:
      break;
  }
  return {};
}

bool Where::covers(int s, int a) const {
  return (scale != Scale::sensor && scale != Scale::axis) ||
         (s == sensor && (scale == Scale::sensor || a == axis));
}

}  // namespace mgtd::calib::effects
