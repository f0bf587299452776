// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/axis_effect.h"

namespace mgtd::calib::effects::laws {

std::string_view missing_temperature(const Pose& pose, int sensor) {
  static constexpr std::array<std::string_view, kSensors> kColumns{"s1_T_degC", "s2_T_degC", "s3_T_degC",
                                                                   "s4_T_degC"};
  const auto s = static_cast<std::size_t>(sensor);
  return pose.T_degC[s] ? std::string_view() : kColumns[s];
}

}  // namespace mgtd::calib::effects::laws
