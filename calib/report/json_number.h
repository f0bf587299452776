// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>

namespace mgtd::calib::report {

/// number_or_null() writes a number as JSON. JSON has no infinity and no NaN: what is not finite is null.
[[nodiscard]] inline nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

}  // namespace mgtd::calib::report
