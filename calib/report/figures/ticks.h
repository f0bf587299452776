// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/report/figures/scale.h"

/// Ticks says where an axis is marked, and with which numbers.
namespace mgtd::calib::report::figures {

struct Tick {
  double value{0};
  std::string label;  ///< empty: a mark without a number
};

struct Ticks {
  std::vector<Tick> ticks;
  /// Labels are values divided by 10^power: the axis says "×10⁻⁵" beside its unit. 0 where numbers are handy.
  int power{0};
};

/// Linear: multiples of 1, 2 or 5 times a power of ten, `about` of them, all with the same number of
/// decimals. Log: powers of ten; within less than two decades also 2 and 5, within a factor of
/// five as linear; over many decades not each of
/// them. A tick is never outside the range.
[[nodiscard]] Ticks ticks_of(const Range& range, ScaleKind kind, int about);

/// Of angles in degrees over a whole turn or a part of it: multiples of 15, 30, 45 or 90 where they fit.
[[nodiscard]] Ticks angle_ticks_of(const Range& range_deg, int about);

/// "-0.25" with a true minus sign, "×10⁻⁵".
[[nodiscard]] std::string number_label(double value, int decimals);
[[nodiscard]] std::string power_label(int power);
/// To three significant digits, for captions and tables: "0.0190", "53900", "2.1e-64".
[[nodiscard]] std::string short_number(double value);

}  // namespace mgtd::calib::report::figures
