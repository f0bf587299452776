// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

#include "calib/fit/fit_report.h"

/// The result of `mgt fit --json`, schema "mgt.fit/1". Plain numbers in the unit named by the key's suffix,
/// angles in degrees, standard deviations beside the values. What does not exist (no held-out error, no
/// halves) is null.
namespace mgtd::calib {

[[nodiscard]] nlohmann::json to_json(const FitReport& report);
[[nodiscard]] nlohmann::json to_json(const ErrorSummary& errors);

/// Key, unit and factor from the inside unit to the one shown, of each of the twelve parameters.
struct ShownParameter {
  const char* key;   ///< "theta_deg"
  const char* name;  ///< "theta"
  const char* unit;  ///< "deg"; empty for scale factors
  double factor;
};
[[nodiscard]] const std::array<ShownParameter, kSensorParameters>& shown_parameters();

}  // namespace mgtd::calib
