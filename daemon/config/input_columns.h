// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <set>
#include <string>

#include "daemon/config/config.h"
#include "drivers/settings.h"

/// InputColumns knows which columns the inputs of all devices add to the pose table, and refuses a name that
/// is taken.
namespace mgtd::daemon::config {

class InputColumns {
 public:
  InputColumns();

  /// An input is a column beside those that are there already, and named once. Mistakes go to the device's
  /// settings `s`, warnings to `config`.
  void add(drivers::Settings& s, const DeviceConfig& device, Config& config);

 private:
  std::set<std::string, std::less<>> fixed_{"pose", "set", "t_utc"};  ///< of every pose table
  std::map<std::string, std::string> measured_;                       ///< and where each is measured
};

}  // namespace mgtd::daemon::config
