// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/discovery/discovery_report.h"

/// What discover() found, as an object (schema mgt.discover/1) and for a person. `run` as the person typed
/// it, for the commands that the text proposes.
namespace mgtd::calib::report {

[[nodiscard]] nlohmann::json to_json(const discovery::DiscoveryReport& report, const std::string& run);
[[nodiscard]] std::string to_text(const discovery::DiscoveryReport& report, const std::string& run);

}  // namespace mgtd::calib::report
