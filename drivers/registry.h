// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <span>
#include <string_view>

#include "drivers/device.h"
#include "drivers/settings.h"

/// The registry finds a driver by the name that the configuration uses. A new protocol is a pair of files and
/// one line in registry.cc.
namespace mgtd::drivers {

enum class Role { sensor, table, scalar, auxiliary };

struct DriverEntry {
  std::string_view name;
  Role role;
  std::string_view summary;
  /// Reads its settings; objections are left in `settings`. `slot` is the sensor's number (0 based), else
  /// ignored.
  std::unique_ptr<Device> (*make)(int slot, Settings& settings);
  bool has_port{true};  ///< false: nothing is plugged in
};

[[nodiscard]] std::span<const DriverEntry> drivers();
[[nodiscard]] const DriverEntry* find_driver(std::string_view name);

}  // namespace mgtd::drivers
