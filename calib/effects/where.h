// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "proto/error.h"
#include "proto/per_sensor.h"

/// A Where says which sensors and axes an effect is laid over, and how many coefficients that takes.
namespace mgtd::calib::effects {

struct Where {
  enum class Scale {
    all,          ///< one coefficient for the axes of all sensors
    each_sensor,  ///< one a sensor
    each_axis,    ///< one an axis, s1.x, s1.y, ...
    sensor,       ///< one, for the axes of one sensor: "s3"
    axis,         ///< one, for one axis: "s3.z"
    own           ///< effects of site, table and platform as a whole
  };
  Scale scale{Scale::each_axis};
  int sensor{-1}, axis{-1};  ///< 0-based, of `sensor` and `axis`
  int sensors{kSensors};     ///< of the array; not part of the text

  /// "all", "each-sensor", "each-axis", "s3", "s3.z"; "site", "platform" and "table" are `own`.
  [[nodiscard]] static Result<Where> parse(std::string_view text);
  /// `own` gives an empty text.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool covers(int sensor, int axis) const;
  bool operator==(const Where&) const = default;
};

/// "s3", "s3.z"
[[nodiscard]] std::string sensor_name(int sensor);
[[nodiscard]] std::string axis_name(int sensor, int axis);

}  // namespace mgtd::calib::effects
