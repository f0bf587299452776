// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

/// This makes small drawings for the report, as inline SVG: nothing is loaded, nothing runs.
namespace mgtd::daemon::cli {

/// Text as HTML and SVG need it.
[[nodiscard]] std::string escaped(const std::string& text);

struct SeriesPlot {
  std::vector<double> y;      ///< means over equally filled bins of x
  double from{0}, to{0};      ///< of x
  std::string x_label, unit;  ///< unit of y
  double scale{0};            ///< half height: plots of one channel share it
  bool stands_out{false};
};
[[nodiscard]] std::string svg_series(const SeriesPlot& plot);

struct Bar {
  std::string label;
  double value{0};
  std::string text;  ///< at its end
  int tone{0};       ///< 0 blue, 1 vermilion, 2 grey
};
/// Horizontal bars on one scale from zero; `mark` is a dashed line across them.
[[nodiscard]] std::string svg_bars(const std::vector<Bar>& bars, std::optional<double> mark,
                                   const std::string& mark_text);

}  // namespace mgtd::daemon::cli
