// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/platform_bending.h"

namespace mgtd::calib::effects::laws {
namespace {

constexpr double kPrior_deg = 0.1;

}  // namespace

Flexure::Flexure(const Where& where)
    : PlatformEffect(
          {{"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"}, "deg", 0.01, where, kPrior_deg}) {}

ThermalBending::ThermalBending(const Where& where)
    : PlatformEffect({{"x", "y", "z"}, "arcsec/degC", 5, where}) {}

std::string_view ThermalBending::missing(const Pose& pose) const {
  for (int sensor = 0; sensor < scale().where().sensors; ++sensor) {
    if (at(sensor).empty()) continue;
    if (const auto column = missing_temperature(pose, sensor); !column.empty()) return column;
  }
  return {};
}

}  // namespace mgtd::calib::effects::laws
