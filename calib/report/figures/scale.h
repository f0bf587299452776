// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

/// A Scale maps values of an axis to places on the drawing.
namespace mgtd::calib::report::figures {

enum class ScaleKind { linear, log };

/// `from` and `to` in the units of the axis; a log range is positive.
struct Range {
  double from{0}, to{1};
};

class Scale {
 public:
  /// `range` from the place `at_from` to the place `at_to`. An empty range is widened, so that no place is
  /// NaN.
  Scale(Range range, double at_from, double at_to, ScaleKind kind = ScaleKind::linear);

  [[nodiscard]] double operator()(double value) const;
  /// Finite, and within the range up to rounding.
  [[nodiscard]] bool holds(double value) const;
  [[nodiscard]] const Range& range() const { return range_; }
  [[nodiscard]] ScaleKind kind() const { return kind_; }

 private:
  Range range_;
  ScaleKind kind_;
  double at_from_, per_unit_;
};

/// Of the finite values (on a log axis: the positive ones), with `margin` of their span to either side. Where
/// there are none: 0 to 1, or 1 to 10.
[[nodiscard]] Range range_of(std::span<const double> values, ScaleKind kind = ScaleKind::linear,
                             double margin = 0.05);
/// Two of the finite values differ.
[[nodiscard]] bool spread_out(std::span<const double> values);
/// The smallest range that holds a and b.
[[nodiscard]] Range joined(const Range& a, const Range& b);
/// -x to x where x is the largest magnitude, with the same margin.
[[nodiscard]] Range symmetric_range_of(std::span<const double> values, double margin = 0.05);

}  // namespace mgtd::calib::report::figures
