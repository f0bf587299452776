// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/platform_scale.h"

#include "calib/effects/effect_spec.h"

namespace mgtd::calib::effects::laws {

PlatformScale::PlatformScale(const std::vector<std::string>& names, const char* unit, double typical,
                             const Where& where, double prior_sd)
    : where_(where), at_(static_cast<std::size_t>(where.sensors)) {
  for (int sensor = 0; sensor < where.sensors; ++sensor) {
    if (where.scale == Where::Scale::sensor && sensor != where.sensor) continue;
    for (const std::string& name : names) {
      at_[static_cast<std::size_t>(sensor)].push_back(static_cast<int>(coefficients_.size()));
      coefficients_.push_back(
          {.name = sensor_name(sensor) + "." + name, .unit = unit, .typical = typical, .prior_sd = prior_sd});
    }
  }
}

std::string PlatformScale::spec(std::string_view name) const {
  return EffectSpec{.name = std::string(name), .where = where_, .parameters = {}}.text();
}

}  // namespace mgtd::calib::effects::laws
