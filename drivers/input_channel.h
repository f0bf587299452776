// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/settings.h"
#include "proto/reading.h"

/// An InputChannel is an analogue input of a device; its reading becomes a column of the pose table:
///
///     column = scale * reading + offset
///
/// in `unit`. The column sN_T_degC is the temperature of sensor N and goes out as TemperatureReading; every
/// other one goes out as AuxiliaryReading under its own name. What the device cannot measure (the input is at
/// the end of its range) is left out. That a column is named once, and by nothing else of the pose table, is
/// for the reader of the whole configuration.
namespace mgtd::drivers {

struct InputChannel {
  std::size_t index{0};  ///< among the inputs of the device
  std::string input;     ///< as the device calls it: "q", "2"
  std::string key;       ///< of the device's settings that names the column: "inputs.q.name"
  std::string column;
  std::string unit;  ///< empty: not known
  double scale{1};   ///< `unit` per unit of the reading
  double offset{0};
};

/// Of the sensor whose temperature the column is, 0 for s1_T_degC; as many as an array can have.
[[nodiscard]] std::optional<int> sensor_of(std::string_view column);

/// The unit that the end of the name tells: "A" of motor_A. Empty: none that is known.
[[nodiscard]] std::string_view unit_of_name(std::string_view column);

/// Objects, in `settings`, to a name that no formula could use and to a unit that its end contradicts.
void check_column(const InputChannel& channel, Settings& settings);

/// Tells `emit` what one look at the inputs found. `readings` of all inputs of the device, by their index;
/// empty: not measured.
void report_inputs(std::span<const InputChannel> channels, std::span<const std::optional<double>> readings,
                   Stamp arrival, const std::function<void(DeviceEvent)>& emit);

}  // namespace mgtd::drivers
