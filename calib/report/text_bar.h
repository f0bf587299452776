// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace mgtd::calib::report {

/// bar() draws a bar of at most `width` characters for `value` on a scale that ends at `top`.
[[nodiscard]] inline std::string bar(double value, double top, int width = 40) {
  const double share = top > 0 ? std::clamp(value / top, 0.0, 1.0) : 0;
  return std::string(static_cast<std::size_t>(std::lround(share * width)), '#');
}

/// Characters for a bar at the end of a line of `width` columns of which `taken` stand before it: at most
/// `wished`, and none where only a stump would fit.
[[nodiscard]] inline int bar_room(std::size_t width, std::size_t taken, int wished = 40) {
  constexpr std::size_t kStump = 8;
  if (width < taken + kStump) return 0;
  return static_cast<int>(std::min(width - taken, static_cast<std::size_t>(wished)));
}

}  // namespace mgtd::calib::report
