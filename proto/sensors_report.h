// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "proto/per_sensor.h"
#include "proto/reading.h"
#include "proto/time.h"

/// A SensorsReport says what each sensor reads: means over the epochs since the report before, about one
/// second. It is the line SENSORS of the live stream:
///
///   {"from_seq","to_seq","t","t_ns","frame":"platform","cal": id or null,
///    "table":{"azimuth_deg","pitch_deg","roll_deg"} or null,
///    "sensors":[{"name":"s1","epochs","raw_nT":[x,y,z],"sd_nT":[x,y,z],"b_nT":[x,y,z],"f_nT","T_degC"}]}
///
/// Numbers have at most six decimals. What is not known is null.
namespace mgtd {

/// Of one sensor. NaN: not known.
struct SensorMean {
  std::uint64_t epochs{0};  ///< of which it is the mean
  Eigen::Vector3d y_nT{Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};   ///< readings
  Eigen::Vector3d sd_nT{Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};  ///< of one
  Eigen::Vector3d b_P_nT{
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};  ///< calibrated
  double T_degC{std::numeric_limits<double>::quiet_NaN()};                   ///< the latest
};

struct SensorsReport {
  std::uint64_t from_seq{0}, to_seq{0};      ///< the first and the last epoch
  WallTime t{};                              ///< of the last
  std::optional<std::string> calibration{};  ///< that made every b_P_nT; empty: the last epoch was raw
  std::optional<TableAngles> table{};        ///< of a table that stood still all the time
  PerSensor<SensorMean> sensors{};
};

[[nodiscard]] nlohmann::ordered_json to_json(const SensorsReport& report);

}  // namespace mgtd
