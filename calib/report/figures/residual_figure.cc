// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/residual_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/report/figures/density.h"

namespace mgtd::calib::report::figures {
namespace {

constexpr std::size_t kMostRows = 400;

struct BinsOff {
  std::size_t off{0}, bins{0};
};

BinsOff bins_off_zero(const ResidualView& view) {
  BinsOff out;
  for (const Series& s : view.series) {
    const BinnedMeans m = binned_means(s.x, s.y);
    for (std::size_t i = 0; i < m.means.size(); ++i) {
      if (!std::isfinite(m.standard_errors[i])) continue;
      ++out.bins;
      if (std::abs(m.means[i]) > 2 * m.standard_errors[i]) ++out.off;
    }
  }
  return out;
}

std::string said_of(const ResidualView& view) {
  const BinsOff b = bins_off_zero(view);
  return fmt::format("{} of {} means lie off zero{}{}", b.off, b.bins, view.p_text.empty() ? "" : ", ",
                     view.p_text);
}

std::vector<double> all_of(const ResidualValues& v, bool x) {
  std::vector<double> out;
  for (const ResidualView* view : {&v.before, &v.after})
    for (const Series& s : view->series)
      out.insert(out.end(), (x ? s.x : s.y).begin(), (x ? s.x : s.y).end());
  return out;
}

void draw_view(Drawing& drawing, const Box& box, const ResidualView& view, const Axis& x, const Axis& y) {
  Plot plot(drawing, box, x, y);
  plot.rule_y(0, {.stroke = Tone::quiet, .width = 1});
  if (view.series.empty()) return plot.message("nothing to show");
  plot.points(view.series);
  const bool single = view.series.size() == 1;
  for (const Series& s : view.series) {
    const BinnedMeans m = binned_means(s.x, s.y);
    plot.means(m.centres, m.means, m.standard_errors, single ? Tone::ink : s.tone);
  }
}

DataTable by_pose(const ResidualValues& v) {
  DataTable out{.head = {"pose", v.x_label}, .rows = {}, .note = ""};
  const auto& first = v.before.series.front();
  for (const ResidualView* view : {&v.before, &v.after})
    for (const Series& s : view->series)
      out.head.push_back(s.name + (view == &v.before ? "" : ", " + v.after_title));
  for (std::size_t i = 0; i < first.x.size(); ++i) {
    std::vector<std::string> row{
        first.poses.empty() ? fmt::format("{}", i + 1) : fmt::format("{}", first.poses[i]),
        short_number(first.x[i])};
    for (const ResidualView* view : {&v.before, &v.after})
      for (const Series& s : view->series) row.push_back(i < s.y.size() ? short_number(s.y[i]) : "");
    out.rows.push_back(std::move(row));
  }
  return out;
}

DataTable by_bin(const ResidualValues& v) {
  DataTable out{.head = {"", v.x_label, "mean", "standard error", "points"},
                .rows = {},
                .note = "Of so many points the means over equally filled bins."};
  for (const ResidualView* view : {&v.before, &v.after}) {
    for (const Series& s : view->series) {
      const BinnedMeans m = binned_means(s.x, s.y);
      for (std::size_t i = 0; i < m.means.size(); ++i)
        out.rows.push_back({s.name + (view == &v.before ? "" : ", " + v.after_title),
                            short_number(m.centres[i]), short_number(m.means[i]),
                            short_number(m.standard_errors[i]), fmt::format("{}", m.counts[i])});
    }
  }
  return out;
}

}  // namespace

Figure residual_figure(const ResidualValues& v) {
  const bool pair = !v.after.series.empty();
  constexpr double kPlotHeight = 240, kBetween = 14, kHead = 18;
  const double width = pair ? 820 : 410;
  Drawing drawing(v.name, width, kPlotHeight + kHead);
  const Axis x{.label = v.x_label,
               .range = range_of(all_of(v, true), ScaleKind::linear, 0.03),
               .angle_deg = v.angle_deg};
  const Axis y{.label = v.y_label, .range = symmetric_range_of(all_of(v, false))};
  const double top = kHead + Plot::kTop - 6, height = kPlotHeight + kHead - top - Plot::kBottom;
  const double each =
      pair ? (width - Plot::kLeft - Plot::kRight - kBetween - 10) / 2 : width - Plot::kLeft - Plot::kRight;
  const Box left{Plot::kLeft, top, each, height};
  draw_view(drawing, left, v.before, x, y);
  std::vector<LegendEntry> legend;
  for (const Series& s : v.before.series)
    legend.push_back({.name = s.name, .tone = s.tone, .shape = s.shape});
  if (pair) {
    const Box right{Plot::kLeft + each + kBetween + 10, top, each, height};
    Axis bare = y;
    bare.label.clear();
    bare.numbers = false;
    draw_view(drawing, right, v.after, x, bare);
    drawing.text({left.x, 14}, v.before_title, Anchor::start, Tone::ink, kFontSize, true);
    drawing.text({right.x, 14}, v.after_title, Anchor::start, Tone::ink, kFontSize, true);
    if (v.before.series.size() > 1)
      draw_legend(drawing, {left.x + each + 14 - legend_width(legend), 14}, legend, each);
  } else if (legend.size() > 1) {
    draw_legend(drawing, {left.x, 14}, legend, each);
  } else if (!legend.empty()) {
    drawing.text({left.x, 14}, legend.front().name, Anchor::start, Tone::ink, kFontSize, true);
  }
  Figure out{.name = v.name, .title = v.title, .svg = {}, .caption = v.what, .good = {}, .data = {}};
  if (pair) out.caption += fmt::format(" Left {}, right {}; equal axes.", v.before_title, v.after_title);
  out.caption += " Lines: means over equally filled bins, with two standard errors.";
  out.good =
      "the means scatter about zero without a shape, all but one in twenty within two standard errors (p "
      "above "
      "0.001). Here " +
      said_of(v.before) + (pair ? "; with the effects " + said_of(v.after) : "") + ".";
  if (!v.before.series.empty())
    out.data = v.before.series.front().x.size() > kMostRows ? by_bin(v) : by_pose(v);
  out.wide = pair;
  out.stands_out = v.stands_out;
  out.svg = drawing.finished(v.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
