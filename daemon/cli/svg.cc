// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace mgtd::daemon::cli {
namespace {

/// Colours that can be distinguished with every kind of colour vision.
constexpr std::array kTones{"#0072b2", "#d55e00", "#9aa0a6"};

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string svg_series(const SeriesPlot& plot) {
  constexpr double kWidth = 180, kHeight = 92, kLeft = 4, kRight = 4, kTop = 16, kBottom = 18;
  const double middle = (kTop + kHeight - kBottom) / 2, half = (kHeight - kBottom - kTop) / 2;
  const char* const tone = kTones[plot.stands_out ? 1 : 0];
  std::string out = fmt::format("<svg class=\"series\" viewBox=\"0 0 {} {}\" role=\"img\">", kWidth, kHeight);
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2}\" y2=\"{2}\" class=\"zero\"/>", kLeft,
                 kWidth - kRight, middle);
  std::string points;
  const double n = static_cast<double>(plot.y.size());
  for (std::size_t i = 0; i < plot.y.size(); ++i) {
    const double x = kLeft + (kWidth - kLeft - kRight) * (static_cast<double>(i) + 0.5) / n;
    const double share = plot.scale > 0 ? std::clamp(plot.y[i] / plot.scale, -1.0, 1.0) : 0;
    const double y = middle - half * share;
    points += fmt::format("{:.1f},{:.1f} ", x, y);
    fmt::format_to(to, "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.4\" fill=\"{}\"/>", x, y, tone);
  }
  fmt::format_to(to,
                 "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1\" opacity=\"0.6\"/>",
                 points, tone);
  fmt::format_to(to, "<text x=\"{}\" y=\"10\">±{:.3g} {}</text>", kLeft, plot.scale, escaped(plot.unit));
  fmt::format_to(to, "<text x=\"{}\" y=\"{}\">{:.3g}</text>", kLeft, kHeight - 5, plot.from);
  fmt::format_to(to, "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", kWidth / 2, kHeight - 5,
                 escaped(plot.x_label));
  fmt::format_to(to, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.3g}</text></svg>", kWidth - kRight,
                 kHeight - 5, plot.to);
  return out;
}

std::string svg_bars(const std::vector<Bar>& bars, std::optional<double> mark, const std::string& mark_text) {
  constexpr double kWidth = 900, kLabel = 330, kValue = 150, kRow = 22;
  double top = mark.value_or(0);
  for (const Bar& bar : bars) top = std::max(top, bar.value);
  const double unit = top > 0 ? (kWidth - kLabel - kValue) / top : 0;
  const double height = kRow * static_cast<double>(bars.size()) + (mark ? 20 : 4);
  std::string out = fmt::format("<svg class=\"bars\" viewBox=\"0 0 {} {}\" role=\"img\">", kWidth, height);
  const auto to = std::back_inserter(out);
  double y = 2;
  for (const Bar& bar : bars) {
    fmt::format_to(to, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>", kLabel - 8, y + 14,
                   escaped(bar.label));
    fmt::format_to(to, "<rect x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\" rx=\"2\" fill=\"{}\"/>",
                   kLabel, y + 3, std::max(1.0, unit * bar.value), kRow - 7,
                   kTones.at(static_cast<std::size_t>(bar.tone)));
    fmt::format_to(to, "<text x=\"{:.1f}\" y=\"{}\">{}</text>", kLabel + unit * bar.value + 6, y + 14,
                   escaped(bar.text));
    y += kRow;
  }
  if (mark) {
    const double x = kLabel + unit * *mark;
    fmt::format_to(to, "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"0\" y2=\"{1}\" class=\"mark\"/>", x, y + 4);
    // Beside the line, on the side where there is room.
    const bool right = x > kWidth / 2;
    fmt::format_to(to, "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"{}\" class=\"quiet\">{}</text>",
                   x + (right ? -5 : 5), y + 13, right ? "end" : "start", escaped(mark_text));
  }
  return out + "</svg>";
}

}  // namespace mgtd::daemon::cli
