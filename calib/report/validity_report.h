// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "calib/validity/validity_check.h"

namespace mgtd::calib::report {

/// validity_reasons() says whether the calibration still holds and why, then what limits the answer; one
/// sentence each.
[[nodiscard]] std::vector<std::string> validity_reasons(const validity::ValidityReport& report);

/// Schema "mgt.check/1".
[[nodiscard]] nlohmann::json to_json(const validity::ValidityReport& report);

}  // namespace mgtd::calib::report
