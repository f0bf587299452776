// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "daemon/run/wiring.h"
#include "proto/check.h"
#include "proto/pose.h"

/// WiringWatch reports from the poses of a run how the sensors are wired, once the turns of the table have
/// shown it, and again when further ones show more.
namespace mgtd::daemon::run {

class WiringWatch {
 public:
  /// The check `wiring`, where it is another one than before.
  [[nodiscard]] std::optional<Check> add(const Pose& pose);

 private:
  Wiring wiring_;
  std::vector<std::string> said_;
};

}  // namespace mgtd::daemon::run
