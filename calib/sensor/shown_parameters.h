// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "calib/sensor/sensor_model.h"

namespace mgtd::calib::sensor {

/// A ShownParameter gives key, unit and factor from the internal unit to the one shown, for one of the twelve
/// parameters.
struct ShownParameter {
  const char* key;   ///< "theta_deg"
  const char* name;  ///< "theta"
  const char* unit;  ///< "deg"; empty for scale factors
  double factor;
};
[[nodiscard]] const std::array<ShownParameter, kSensorParameters>& shown_parameters();

}  // namespace mgtd::calib::sensor
