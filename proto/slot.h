// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "proto/reading.h"

/// A Slot is the place of one instrument in the rig: a sensor, the table, the scalar reference or an
/// auxiliary module. Its number is the one under which the journal records the instrument; its name is the
/// one of the configuration.
namespace mgtd {

class Slot {
 public:
  [[nodiscard]] static constexpr Slot sensor(int index) { return Slot(static_cast<std::uint8_t>(index)); }
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
    return number_ < kTable ? std::optional<int>(number_) : std::nullopt;
  }
  /// "s1" .. "s4", "table", "scalar", "aux1", ...
  [[nodiscard]] std::string name() const {
    if (number_ < kTable) return "s" + std::to_string(number_ + 1);
    if (number_ == kTable) return "table";
    if (number_ == kScalar) return "scalar";
    return "aux" + std::to_string(number_ - kFirstAuxiliary + 1);
  }
  auto operator<=>(const Slot&) const = default;  // NOLINT(modernize-use-nullptr): a false alarm

 private:
  static constexpr std::uint8_t kTable = kSensors, kScalar = kTable + 1, kFirstAuxiliary = kScalar + 1;
  explicit constexpr Slot(std::uint8_t number) : number_(number) {}

  std::uint8_t number_;
};

}  // namespace mgtd
