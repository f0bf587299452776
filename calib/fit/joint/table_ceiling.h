// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "proto/units.h"

/// The joint fit estimates how far the attitudes scatter about the table's angles up to a ceiling: from there
/// on the angles tell nothing, and the estimate is a lower bound.
namespace mgtd::calib::fit::joint {

inline constexpr double kTableCeiling_rad = to_rad(10);

/// What stands behind such an estimate in a sentence: " or more" at the ceiling, else nothing.
[[nodiscard]] constexpr std::string_view or_more(double table_sd_rad) {
  return table_sd_rad < 0.999 * kTableCeiling_rad ? "" : " or more";
}

}  // namespace mgtd::calib::fit::joint
