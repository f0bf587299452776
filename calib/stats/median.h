// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

namespace mgtd::calib::stats {

/// median() gives the upper median: of n values the one that has n/2 of them, rounded down, below it. 0 of
/// none.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace mgtd::calib::stats
