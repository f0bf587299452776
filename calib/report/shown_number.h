// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>

namespace mgtd::calib::report {

/// shown_number() writes a cell of a table of numbers, right-aligned; it shows "-" for NaN, which stands for
/// what the array cannot tell.
[[nodiscard]] inline std::string shown_number(double value, int width, int decimals) {
  return std::isnan(value) ? fmt::format("{:>{}}", "-", width)
                           : fmt::format("{:>{}.{}f}", value, width, decimals);
}

}  // namespace mgtd::calib::report
