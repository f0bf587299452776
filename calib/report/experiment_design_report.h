// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "calib/design/experiment_design.h"

/// The report of an experiment design, as a JSON object (schema "mgt.plan/1") and as text.
namespace mgtd::calib {

[[nodiscard]] nlohmann::json to_json(const DesignReport& report);
[[nodiscard]] std::string to_text(const DesignReport& report);

}  // namespace mgtd::calib
