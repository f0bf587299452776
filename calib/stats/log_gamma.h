// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

namespace mgtd::calib::stats {

/// log_gamma() computes ln |Gamma(x)| and may be called from several threads. std::lgamma writes the sign to
/// a global variable, and two threads may ask at once.
[[nodiscard]] inline double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace mgtd::calib::stats
