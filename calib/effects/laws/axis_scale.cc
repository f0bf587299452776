// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/axis_scale.h"

#include <algorithm>

namespace mgtd::calib::effects::laws {
namespace {

/// What the coefficients of an axis are called before their suffix; axes of one group share them.
std::string group_of(int sensor, int axis, const Where& where, bool axes_alike) {
  const std::string own_axis(1, "xyz"[axis]);
  switch (where.scale) {
    case Where::Scale::all:
      return axes_alike ? "all" : own_axis;
    case Where::Scale::each_sensor:
    case Where::Scale::sensor:
      return axes_alike ? sensor_name(sensor) : axis_name(sensor, axis);
    default:
      return axis_name(sensor, axis);
  }
}

}  // namespace

AxisScale::AxisScale(const AxisCoefficients& law, const Where& where)
    : at_(static_cast<std::size_t>(where.sensors)), first_(static_cast<std::size_t>(where.sensors)) {
  for (int sensor = 0; sensor < sensors(); ++sensor) {
    const auto s = static_cast<std::size_t>(sensor);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      first_[s][a] = -1;
      if (!where.covers(sensor, axis)) continue;
      for (const std::string& suffix : law.suffix[a]) {
        const std::string name = group_of(sensor, axis, where, law.axes_alike) + suffix;
        const auto same = std::find_if(coefficients_.begin(), coefficients_.end(),
                                       [&](const Coefficient& c) { return c.name == name; });
        const auto index = static_cast<int>(same - coefficients_.begin());
        if (same == coefficients_.end()) {
          coefficients_.push_back({.name = name, .unit = law.unit, .typical = law.typical});
        }
        const auto known = std::find(at_[s].begin(), at_[s].end(), index);
        if (first_[s][a] < 0) first_[s][a] = static_cast<int>(known - at_[s].begin());
        if (known == at_[s].end()) at_[s].push_back(index);
      }
    }
  }
}

}  // namespace mgtd::calib::effects::laws
