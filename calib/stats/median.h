// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

namespace mgtd::calib::stats {

/// The upper median: of n values the one with n/2 below it, counted down. 0 of none.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace mgtd::calib::stats
