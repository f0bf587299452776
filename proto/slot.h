// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "proto/per_sensor.h"

/// A Slot is the place of one instrument in the rig: a sensor, the table, the scalar reference or an
/// auxiliary module. Its name is the one of the configuration. Its number is the one under which the journal
/// records the instrument:
///
///     0..3 s1 to s4    4 table    5 scalar    6.. auxiliary modules    128..139 s5 to s16
///
/// The first sensors stand where they stood when there were four, so that an old journal reads the same.
namespace mgtd {

class Slot {
 public:
  [[nodiscard]] static constexpr Slot sensor(int index) {
    return Slot(static_cast<std::uint8_t>(index < kTable ? index : kFurtherSensors + index - kTable));
  }
  [[nodiscard]] static constexpr Slot table() { return Slot(kTable); }
  [[nodiscard]] static constexpr Slot scalar() { return Slot(kScalar); }
  /// `index` counts the modules from 0.
  [[nodiscard]] static constexpr Slot auxiliary(int index) {
    return Slot(static_cast<std::uint8_t>(kFirstAuxiliary + index));
  }
  [[nodiscard]] static constexpr Slot numbered(std::size_t number) {
    return Slot(static_cast<std::uint8_t>(number));
  }

  [[nodiscard]] constexpr std::uint8_t number() const { return number_; }
  /// Counted from 0; empty for what is no sensor.
  [[nodiscard]] constexpr std::optional<int> sensor_index() const {
    if (number_ < kTable) return number_;
    if (number_ >= kFurtherSensors) return number_ - kFurtherSensors + kTable;
    return std::nullopt;
  }
  /// "s1" .. "s16", "table", "scalar", "aux1", ...
  [[nodiscard]] std::string name() const {
    if (const auto sensor = sensor_index()) return "s" + std::to_string(*sensor + 1);
    if (number_ == kTable) return "table";
    if (number_ == kScalar) return "scalar";
    return "aux" + std::to_string(number_ - kFirstAuxiliary + 1);
  }
  auto operator<=>(const Slot&) const = default;  // NOLINT(modernize-use-nullptr): a false alarm

  static constexpr int kMostAuxiliary = 122;  ///< modules that have a number

 private:
  static constexpr std::uint8_t kTable = 4, kScalar = 5, kFirstAuxiliary = 6, kFurtherSensors = 128;
  explicit constexpr Slot(std::uint8_t number) : number_(number) {}

  std::uint8_t number_;
};

}  // namespace mgtd
