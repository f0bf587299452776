// SPDX-License-Identifier: Apache-2.0
#include "proto/sensors_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "proto/slot.h"
#include "proto/units.h"

namespace mgtd {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson rounded_or_null(double value) {
  constexpr double kMicro = 1e6;
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * kMicro) / kMicro + 0.0;  // without the sign of a zero
}

OrderedJson vector_or_null(const Eigen::Vector3d& v) {
  if (!v.allFinite()) return nullptr;
  return {rounded_or_null(v.x()), rounded_or_null(v.y()), rounded_or_null(v.z())};
}

OrderedJson angles_or_null(const std::optional<TableAngles>& table) {
  if (!table) return nullptr;
  return {{"azimuth_deg", rounded_or_null(to_deg(table->azimuth_rad))},
          {"pitch_deg", rounded_or_null(to_deg(table->pitch_rad))},
          {"roll_deg", rounded_or_null(to_deg(table->roll_rad))}};
}

}  // namespace

OrderedJson to_json(const SensorsReport& report) {
  OrderedJson sensors = OrderedJson::array();
  for (std::size_t i = 0; i < report.sensors.size(); ++i) {
    const SensorMean& s = report.sensors[i];
    sensors.push_back({{"name", Slot::sensor(static_cast<int>(i)).name()},
                       {"epochs", s.epochs},
                       {"raw_nT", vector_or_null(s.y_nT)},
                       {"sd_nT", vector_or_null(s.sd_nT)},
                       {"b_nT", vector_or_null(s.b_P_nT)},
                       {"f_nT", rounded_or_null(s.b_P_nT.norm())},
                       {"T_degC", rounded_or_null(s.T_degC)}});
  }
  return {{"from_seq", report.from_seq},
          {"to_seq", report.to_seq},
          {"t", format_utc(report.t)},
          {"t_ns", report.t.ns},
          {"frame", "platform"},
          {"cal", report.calibration ? OrderedJson(*report.calibration) : OrderedJson(nullptr)},
          {"table", angles_or_null(report.table)},
          {"sensors", std::move(sensors)}};
}

}  // namespace mgtd
