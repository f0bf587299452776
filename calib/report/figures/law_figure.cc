// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/law_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/report/figures/plot.h"

namespace mgtd::calib::report::figures {
namespace {

constexpr double kPointwise = 1.96;
constexpr double kWidth = 860, kHeight = 330, kLegend = 22;
constexpr std::array<Tone, kMostFormulas> kFormulaTones{Tone::vermilion, Tone::green, Tone::purple,
                                                        Tone::amber};
constexpr std::array<const char*, kMostFormulas> kFormulaDashes{"", "6 3", "2 3", "8 3 2 3"};

struct Band {
  std::vector<double> low{}, high{};
};

Band band_of(const LawValues& v, double sds) {
  Band out;
  for (std::size_t i = 0; i < v.x.size(); ++i) {
    out.low.push_back(v.y_nT[i] - sds * v.sd_nT[i]);
    out.high.push_back(v.y_nT[i] + sds * v.sd_nT[i]);
  }
  return out;
}

/// Points of the curve at which a formula leaves the band that holds the whole curve.
std::size_t outside(const LawValues& v, const LawFormulaValues& formula) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < v.x.size(); ++i)
    out += std::abs(formula.y_nT[i] - v.y_nT[i]) > v.simultaneous * v.sd_nT[i] ? 1U : 0U;
  return out;
}

std::string good(const LawValues& v) {
  const std::string wanted = "the leading formula stays within the outer band from end to end. ";
  if (v.formulas.empty()) return wanted + "Here no formula can be drawn over this quantity alone.";
  const std::size_t points = outside(v, v.formulas.front());
  if (points == 0) return wanted + fmt::format("Here {} does.", v.formulas.front().name);
  return wanted +
         fmt::format("Here {} leaves it at {} of {} points.", v.formulas.front().name, points, v.x.size());
}

}  // namespace

Figure law_figure(const LawValues& v) {
  Drawing drawing(v.name, kWidth, kHeight);
  const std::size_t shown = std::min(kMostFormulas, v.formulas.size());
  const Band whole = band_of(v, v.simultaneous), pointwise = band_of(v, kPointwise);
  std::vector<double> ys = whole.low;
  ys.insert(ys.end(), whole.high.begin(), whole.high.end());
  for (std::size_t f = 0; f < shown; ++f)
    ys.insert(ys.end(), v.formulas[f].y_nT.begin(), v.formulas[f].y_nT.end());
  Plot plot(
      drawing,
      {Plot::kLeft + 6, kLegend, kWidth - Plot::kLeft - 6 - Plot::kRight, kHeight - kLegend - Plot::kBottom},
      {.label = v.x_label, .range = range_of(v.x)},
      {.label = v.where + (v.of_gain ? ", nT at 50 000 nT" : ", nT"), .range = range_of(ys)});
  plot.band(v.x, whole.low, whole.high, Tone::blue, 0.14);
  plot.band(v.x, pointwise.low, pointwise.high, Tone::blue, 0.22);
  plot.line(v.x, v.y_nT, {.stroke = Tone::blue, .width = 1.8});
  std::vector<LegendEntry> legend{{.name = "without a formula", .tone = Tone::blue, .line = true}};
  for (std::size_t f = 0; f < shown; ++f) {
    plot.line(v.x, v.formulas[f].y_nT, {.stroke = kFormulaTones[f], .width = 1.4, .dash = kFormulaDashes[f]});
    legend.push_back(
        {.name = v.formulas[f].name, .tone = kFormulaTones[f], .line = true, .dash = kFormulaDashes[f]});
  }
  draw_legend(drawing, {plot.box().x, 12}, legend, plot.box().width);
  Figure out{
      .name = v.name,
      .title = "Shape of the law at " + v.where,
      .svg = {},
      .caption = fmt::format(
          "A smooth curve through what the model leaves, up to a constant, which the calibration takes. "
          "Inner band: 95 % at each point; outer band: holds the whole curve with 95 %. Lines: the {} "
          "formulas of largest probability that depend on this quantity alone.",
          shown),
      .good = good(v),
      .data = {.head = {v.x_label, "curve, nT", "standard error, nT"}, .rows = {}},
      .wide = true,
      .stands_out = !v.formulas.empty() && outside(v, v.formulas.front()) > 0};
  if (shown == 0)
    out.caption =
        "A smooth curve through what the model leaves, up to a constant, which the calibration takes. Inner "
        "band: 95 % at each point; outer band: holds the whole curve with 95 %.";
  for (std::size_t f = 0; f < shown; ++f) out.data.head.push_back(v.formulas[f].name + ", nT");
  for (std::size_t i = 0; i < v.x.size(); ++i) {
    std::vector<std::string> row{short_number(v.x[i]), fmt::format("{:+.3g}", v.y_nT[i]),
                                 short_number(v.sd_nT[i])};
    for (std::size_t f = 0; f < shown; ++f) row.push_back(fmt::format("{:+.3g}", v.formulas[f].y_nT[i]));
    out.data.rows.push_back(std::move(row));
  }
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
