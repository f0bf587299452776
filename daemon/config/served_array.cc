// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/served_array.h"

#include <fmt/format.h>

namespace mgtd::daemon::config {

std::optional<Error> not_served(const Config& config) {
  if (config.geometry() == calib::sensor::Geometry(config.baseline_m)) return std::nullopt;
  return Error{ErrorCode::refused,
               fmt::format("[array] describes {}, and mgtd drives the cross of four sensors alone",
                           config.array->sensors() == kSensorCount
                               ? std::string("four sensors that are no cross")
                               : fmt::format("an array of {}", config.array->sensors())),
               "record with another program, and calibrate with mgt fit POSES.csv --array FILE.toml"};
}

}  // namespace mgtd::daemon::config
