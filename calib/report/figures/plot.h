// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/report/figures/drawing.h"
#include "calib/report/figures/scale.h"
#include "calib/report/figures/ticks.h"

/// A Plot is one pair of axes on a drawing, with what is drawn between them.
///
/// What is not finite is left out; what lies outside the axes is cut off. Above kMostMarks points a plot
/// shows density instead of marks: square bins, the darker the more points in them, and the running median
/// with the band that holds 80 of 100.
namespace mgtd::calib::report::figures {

inline constexpr std::size_t kMostMarks = 2000;

struct Box {
  double x{0}, y{0}, width{0}, height{0};
};

struct Axis {
  std::string label;  ///< with its unit: "temperature of s3, °C"
  Range range{};
  ScaleKind kind{ScaleKind::linear};
  /// In place of numbers: a name at each value.
  std::vector<Tick> names{};
  bool angle_deg{false};  ///< ticks at 30, 45, 90
  bool numbers{true};     ///< false: ticks without labels, where a plot beside it has them
};

/// Points of one kind.
struct Series {
  std::string name{};  ///< for the legend
  std::vector<double> x{}, y{};
  std::vector<double> sd{};    ///< of y, for error bars; empty: none
  std::vector<int> poses{};    ///< numbers, by point; empty: none
  std::vector<bool> hollow{};  ///< left out: drawn as a ring; empty: none
  Tone tone{Tone::blue};
  Shape shape{Shape::circle};
};

class Plot {
 public:
  /// Draws ticks, a faint grid and the labels. `box` is the rectangle between the axes; the caller leaves
  /// room for numbers and labels (margins below).
  Plot(Drawing& drawing, const Box& box, const Axis& x, const Axis& y);

  static constexpr double kLeft = 58, kBottom = 36, kTop = 12, kRight = 10;

  [[nodiscard]] const Scale& x() const { return x_; }
  [[nodiscard]] const Scale& y() const { return y_; }
  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] Drawing& drawing() { return drawing_; }
  [[nodiscard]] bool holds(double x, double y) const { return x_.holds(x) && y_.holds(y); }
  [[nodiscard]] Place at(double x, double y) const { return {x_(x), y_(y)}; }

  void marks(const Series& series, double radius = 2.4);
  /// All series together as density.
  void density(std::span<const Series> all);
  /// Marks, or density where there are too many.
  void points(std::span<const Series> all, double radius = 2.4);
  /// Broken where a value is not finite.
  void line(std::span<const double> x, std::span<const double> y, const Style& style);
  void band(std::span<const double> x, std::span<const double> low, std::span<const double> high, Tone tone,
            double opacity = 0.18);
  /// Across the whole box; the label stands above its right end, or beside its top.
  void rule_y(double y, const Style& style, const std::string& label = "");
  void rule_x(double x, const Style& style, const std::string& label = "");
  /// Means with two standard errors.
  void means(std::span<const double> x, std::span<const double> mean, std::span<const double> se,
             Tone tone = Tone::ink);
  /// What stands in the middle of an empty plot.
  void message(const std::string& text);

 private:
  void draw_x_axis(const Axis& axis);
  void draw_y_axis(const Axis& axis);

  Drawing& drawing_;
  Box box_;
  Scale x_, y_;
};

struct LegendEntry {
  std::string name;
  Tone tone{Tone::blue};
  Shape shape{Shape::circle};
  bool line{false};  ///< a line in place of a mark
  const char* dash{""};
};
/// In one row from `at` to the right, as many as fit into `width`.
void draw_legend(Drawing& drawing, Place at, std::span<const LegendEntry> entries, double width);

[[nodiscard]] double legend_width(std::span<const LegendEntry> entries);

/// Of the i-th sensor: its colour and its shape, the same in every figure.
[[nodiscard]] Tone sensor_tone(std::size_t sensor);
[[nodiscard]] Shape sensor_shape(std::size_t sensor);

}  // namespace mgtd::calib::report::figures
