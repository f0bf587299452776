// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/axis_effect.h"

namespace mgtd::calib::effects::laws {

std::string_view missing_temperature(const Pose& pose, int sensor) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(kMostSensors)> kColumns{
      "s1_T_degC",  "s2_T_degC",  "s3_T_degC",  "s4_T_degC",  "s5_T_degC",  "s6_T_degC",
      "s7_T_degC",  "s8_T_degC",  "s9_T_degC",  "s10_T_degC", "s11_T_degC", "s12_T_degC",
      "s13_T_degC", "s14_T_degC", "s15_T_degC", "s16_T_degC"};
  const auto s = static_cast<std::size_t>(sensor);
  return s < pose.T_degC.size() && pose.T_degC[s] ? std::string_view() : kColumns[s];
}

}  // namespace mgtd::calib::effects::laws
