// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <string>

namespace mgtd::calib::report {

/// bar() draws a bar of at most `width` characters for `value` on a scale that ends at `top`.
[[nodiscard]] inline std::string bar(double value, double top, int width = 40) {
  const double share = top > 0 ? std::clamp(value / top, 0.0, 1.0) : 0;
  return std::string(static_cast<std::size_t>(std::lround(share * width)), '#');
}

}  // namespace mgtd::calib::report
