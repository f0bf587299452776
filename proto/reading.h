// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "proto/flags.h"
#include "proto/per_sensor.h"
#include "proto/time.h"

/// Readings are what instruments report. Slots count from 0 in code and from 1 on every edge (s1 .. s4).
namespace mgtd {

/// Readings nobody has made: NaN, so that a forgotten one cannot pass for a measurement. (Eigen's vectors are
/// not initialised by {}.)
[[nodiscard]] inline PerSensor<Eigen::Vector3d> no_readings(std::size_t sensors = kSensorCount) {
  return {sensors, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
}

/// One sample of one fluxgate. `y_nT` is not a vector in a frame: three readings at nominal scale, along axes
/// that are neither orthogonal nor aligned. Nothing is corrected here.
struct FieldReading {
  int slot{0};
  /// Counts the frames of this device since it was opened, lost ones included if known.
  std::uint64_t seq{0};
  Stamp arrival;                        ///< of the last byte
  std::optional<double> device_time_s;  ///< of the device's own clock, where it sends one (origin: any)
  Eigen::Vector3d y_nT{Eigen::Vector3d::Zero()};
  Flags flags;
};

struct TemperatureReading {
  int slot{0};
  Stamp arrival;
  std::optional<double> sensor_degC;
  std::optional<double> electronics_degC;
  std::optional<double> supply_V;
};

/// Total field of the scalar reference. `good` is the instrument's own word (GSM quality 99).
struct ScalarReading {
  Stamp arrival;
  double f_nT{0};
  int quality{0};
  bool good{false};
};

/// Inputs of an auxiliary module (currents near the array, voltages), each under the name of its column.
struct AuxiliaryReading {
  Stamp arrival;
  std::vector<std::pair<std::string, double>> values;  ///< those that were measured
};

/// Table angles as named in the pose table: b_platform = Rz(azimuth) Ry(pitch) Rx(roll) B_site, passive.
struct TableAngles {
  double azimuth_rad{0};
  double pitch_rad{0};
  double roll_rad{0};
  bool operator==(const TableAngles&) const = default;
};

struct TableReading {
  Stamp arrival;
  TableAngles angles;
  bool referenced{false};
  bool moving{false};
  bool on_target{false};
};

/// A device said no, or did what it was not told. The run is over until the operator has looked.
struct DeviceFault {
  Stamp at;
  std::string what;
  std::string remedy;
};

/// An answer or state change worth a line in the log ("identified as ...", "reference move done").
struct DeviceNote {
  Stamp at;
  std::string what;
};

using DeviceEvent = std::variant<FieldReading, TemperatureReading, ScalarReading, AuxiliaryReading,
                                 TableReading, DeviceFault, DeviceNote>;

}  // namespace mgtd
