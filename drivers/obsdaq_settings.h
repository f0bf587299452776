// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "drivers/input_channel.h"
#include "drivers/obsdaq_protocol.h"
#include "drivers/settings.h"

/// These keys of the configuration describe one ObsDAQ and the fluxgate behind it:
///
///   port, baud, address = "01"
///   serial = ""                 the device's own; stated: another device is refused
///   palmacq = false             behind a PalmAcq time-stamper: 57600 Bd instead of 19200
///   rate_hz = 50
///   range_V = 10                10, 5 or 2.5
///   profile = "mag-13-100"      mag-03-R or mag-13-R, R = 70, 100, 250, 500, 1000 uT for +-10 V; or
///   scale_nT_per_V = [x, y, z]
///   offset_nT = [0, 0, 0]       added after scaling
///   inputs.q.name = "motor_A"   column of the auxiliary input q (or p, r); sN_T_degC: sensor N's temperature
///   inputs.q.unit = "A"
///   inputs.q.scale, offset = 0  column = scale * volts + offset; no scale is needed where the unit is V
///   temperature = "none"        input of this sensor's own thermometer, "p", "q" or "r", as a short form
///   degC_per_V, degC_at_0V = 0  its line; the slope is needed with an input
///
/// Profiles are nominal figures of the sensor family; what a sensor really does is the calibration's affair.
namespace mgtd::drivers::obsdaq {

struct ObsdaqSettings {
  std::string address{"01"};
  std::string serial;  ///< empty: any
  int baud{kDirectBaud};
  bool palmacq{false};
  double rate_hz{50};
  Timing timing;
  Range range{kRanges[0]};
  std::string sensor;  ///< profile name, or "own scale"
  Eigen::Vector3d scale_nT_per_V{Eigen::Vector3d::Zero()};
  Eigen::Vector3d offset_nT{Eigen::Vector3d::Zero()};
  std::vector<InputChannel> inputs;  ///< of p, q, r those that are used; their readings are volts
};

/// `slot`: of the sensor behind it. Mistakes are left in `settings`.
[[nodiscard]] ObsdaqSettings read_obsdaq_settings(Settings& settings, int slot = 0);

}  // namespace mgtd::drivers::obsdaq
