// SPDX-License-Identifier: Apache-2.0
#include "proto/significant.h"

#include <cmath>

namespace mgtd {

double significant(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return value;
  const int decimals = digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  // A power of ten is exact, its inverse is not.
  const double scale = std::pow(10.0, std::abs(decimals));
  return decimals >= 0 ? std::round(value * scale) / scale : std::round(value / scale) * scale;
}

}  // namespace mgtd
