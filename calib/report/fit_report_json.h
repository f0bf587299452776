// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "calib/fit/fit_report.h"

/// to_json() writes the result of a fit as JSON (mgt.fit/1), which `mgt fit --json` prints. Plain numbers in
/// the unit named by the key's suffix, angles in degrees, standard deviations beside the values. What does
/// not exist (no held-out error, no halves) is null.
namespace mgtd::calib::report {

[[nodiscard]] nlohmann::json to_json(const fit::FitReport& report);
[[nodiscard]] nlohmann::json to_json(const fit::ErrorSummary& errors);
[[nodiscard]] nlohmann::json to_json(const fit::FitSummary& summary);

}  // namespace mgtd::calib::report
