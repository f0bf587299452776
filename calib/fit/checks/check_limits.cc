// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/checks/check_limits.h"

#include <algorithm>

namespace mgtd::calib::fit::checks {

double table_limit_rad(double stated_table_sd_rad) {
  return std::clamp(kMaxTableSigmas * stated_table_sd_rad, kByHand_rad, kMaxTable_rad);
}

bool table_is_rough(double estimated_rad, double stated_rad) {
  return estimated_rad > kMaxTableSigmas * stated_rad;
}

}  // namespace mgtd::calib::fit::checks
