// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "drivers/device.h"
#include "drivers/gcs2_protocol.h"
#include "drivers/settings.h"

/// These keys of the configuration describe a turntable behind a GCS 2 controller:
///
///   port, baud = 115200
///   axes.azimuth = "1"              name of the axis in the controller; likewise pitch, roll
///   limits.azimuth = [-180, 180]    deg, narrower than the controller's own; likewise pitch, roll
///   serial = ""                     of the controller; stated: another one is refused
///   velocity_deg_per_s = 10
///   servo_off_in_dwell = true       motor current and servo hold are magnetic noise
///   dwell_tolerance_deg = 0.5       a table that stands and yet turns by more is a fault
namespace mgtd::drivers::gcs2 {

/// Which of the table's angles an axis turns.
enum class Turns { azimuth, pitch, roll };

struct AxisSettings {
  Turns turns{Turns::azimuth};
  std::string name;  ///< "azimuth": for messages
  std::string axis;  ///< in the controller
  std::optional<TableLimits::Range> limits;
};

struct Gcs2Settings {
  std::string serial;  ///< empty: any
  int baud{kDefaultBaud};
  std::vector<AxisSettings> axes;
  double velocity_deg_per_s{10};
  bool servo_off_in_dwell{true};
  double dwell_tolerance_deg{0.5};
};

[[nodiscard]] TableLimits::Range& travel(TableLimits& limits, Turns turns);

/// Mistakes are left in `settings`.
[[nodiscard]] Gcs2Settings read_gcs2_settings(Settings& settings);

}  // namespace mgtd::drivers::gcs2
