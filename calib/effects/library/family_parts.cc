// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/library/family_parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace mgtd::calib::effects::library {

Result<Where> where_of(const EffectSpec& spec, std::span<const Where::Scale> scales) {
  if (!spec.where) return Where{.scale = scales.front(), .sensors = spec.sensors};
  if (spec.where->sensor >= spec.sensors)
    return fail(ErrorCode::usage,
                fmt::format("{} cannot be laid over '{}': the array has {} sensor{}", spec.name,
                            spec.where->text(), spec.sensors, spec.sensors == 1 ? "" : "s"),
                fmt::format("name a sensor from s1 to s{}", spec.sensors));
  if (std::find(scales.begin(), scales.end(), spec.where->scale) != scales.end()) {
    Where out = *spec.where;
    out.sensors = spec.sensors;
    return out;
  }
  const bool own = scales.front() == Where::Scale::own;
  return fail(
      ErrorCode::usage,
      fmt::format("{} cannot be laid over '{}'", spec.name,
                  spec.where->scale == Where::Scale::own ? "site, table or platform" : spec.where->text()),
      !own                ? "all, each-sensor, each-axis, a sensor (s3) or an axis (s3.z)"
      : scales.size() > 1 ? "leave it out, or name a sensor (s3)"
                          : "leave the part after '@' out");
}

}  // namespace mgtd::calib::effects::library
