// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/parameter_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/report/figures/plot.h"
#include "calib/report/figures/text_width.h"

namespace mgtd::calib::report::figures {
namespace {

std::vector<LegendEntry> sensor_legend(const std::vector<std::string>& sensors) {
  std::vector<LegendEntry> out;
  for (std::size_t s = 0; s < sensors.size(); ++s)
    out.push_back({.name = sensors[s], .tone = sensor_tone(s), .shape = sensor_shape(s)});
  return out;
}

struct LargestShift {
  double size{0};
  std::string text{"none"};
  std::size_t beyond_four{0}, all{0};
};

LargestShift largest_shift(const HistoryValues& v) {
  LargestShift out;
  for (const HistoryPoint& p : v.points) {
    for (std::size_t s = 0; s < p.shifts.size(); ++s) {
      for (std::size_t k = 0; k < p.shifts[s].size(); ++k) {
        const double size = std::abs(p.shifts[s][k]);
        if (!std::isfinite(size)) continue;
        ++out.all;
        out.beyond_four += size > 4 ? 1U : 0U;
        if (size > out.size)
          out.size = size, out.text = fmt::format("{:+.1f} of {}.{} on {}", p.shifts[s][k], v.sensors[s],
                                                  v.parameters[k], p.when);
      }
    }
  }
  return out;
}

void draw_shifts(Drawing& drawing, const Box& box, const HistoryValues& v, std::size_t sensor, const Axis& x,
                 const Axis& y) {
  Plot plot(drawing, box, x, y);
  for (const double half : {4.0, 2.0}) {
    const double top = plot.y()(std::min(half, y.range.to)), foot = plot.y()(std::max(-half, y.range.from));
    drawing.open({.fill = Tone::green, .opacity = half > 3 ? 0.10 : 0.16});
    drawing.rect(box.x, top, box.width, foot - top);
    drawing.close();
  }
  plot.rule_y(0, {.stroke = Tone::quiet, .width = 0.8});
  for (const bool far : {false, true}) {
    drawing.open({.fill = far ? Tone::vermilion : Tone::blue, .opacity = far ? 1 : 0.75}, "marks");
    for (const HistoryPoint& p : v.points)
      for (const double shift : p.shifts[sensor])
        if (plot.holds(p.day, shift) && (std::abs(shift) > 4) == far)
          drawing.mark(Shape::circle, plot.at(p.day, shift), far ? 3.2 : 2.2);
    drawing.close();
  }
  for (const HistoryPoint& p : v.points) {
    for (std::size_t k = 0; k < p.shifts[sensor].size(); ++k) {
      const double shift = p.shifts[sensor][k];
      if (!plot.holds(p.day, shift) || std::abs(shift) <= 4) continue;
      const bool right = plot.x()(p.day) + 60 < box.x + box.width;
      drawing.text({plot.x()(p.day) + (right ? 6 : -6), plot.y()(shift) + 4}, v.parameters[k],
                   right ? Anchor::start : Anchor::end, Tone::vermilion);
    }
  }
  drawing.text({0, box.y + 12}, v.sensors[sensor], Anchor::start, Tone::ink, kFontSize, true);
}

}  // namespace

Figure history_figure(const HistoryValues& v) {
  constexpr double kStrip = 92, kGap = 12, kLabel = 80;
  std::vector<double> days, shifts{-5, 5};
  Axis x{.label = "", .range = {}, .names = {{-1e18, ""}}};
  for (const HistoryPoint& p : v.points) {
    days.push_back(p.day);
    x.names.push_back({p.day, p.when});
    for (const auto& sensor : p.shifts) shifts.insert(shifts.end(), sensor.begin(), sensor.end());
  }
  x.range = range_of(days, ScaleKind::linear, 0.06);
  const Axis y{.label = "std. errors", .range = range_of(shifts)};
  const auto n = static_cast<double>(std::max<std::size_t>(1, v.sensors.size()));
  Drawing drawing("history", 820, 8 + n * (kStrip + kGap) + Plot::kBottom - kGap + 4);
  for (std::size_t s = 0; s < v.sensors.size(); ++s) {
    Axis time = x;
    time.numbers = s + 1 == v.sensors.size();
    if (time.numbers) time.label = "calibration";
    draw_shifts(drawing, {kLabel, 8 + static_cast<double>(s) * (kStrip + kGap), 820 - kLabel - 16, kStrip}, v,
                s, time, y);
  }
  const LargestShift most = largest_shift(v);
  Figure out{
      .name = "history",
      .title = "How the parameters moved from calibration to calibration",
      .svg = {},
      .caption =
          "Each dot is one parameter: its shift against the calibration before, in standard errors of the "
          "difference. Bands: two and four standard errors.",
      .good = fmt::format(
          "all dots within four standard errors, as in 99.7 of 100 pairs of an unchanged rig. Here {} "
          "of {} lie beyond; the largest is {}.",
          most.beyond_four, most.all, most.text),
      .data = {.head = {"calibration", "sensor", "parameter", "shift, standard errors"}, .rows = {}},
      .wide = true,
      .stands_out = most.beyond_four > 0};
  for (const HistoryPoint& p : v.points)
    for (std::size_t s = 0; s < p.shifts.size(); ++s)
      for (std::size_t k = 0; k < p.shifts[s].size(); ++k)
        out.data.rows.push_back(
            {p.when, v.sensors[s], v.parameters[k], fmt::format("{:+.2f}", p.shifts[s][k])});
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

Figure price_figure(const PriceValues& v) {
  Drawing drawing("price", 820, 230);
  std::vector<double> all{1};
  for (const auto& sensor : v.sd_ratio) all.insert(all.end(), sensor.begin(), sensor.end());
  Axis x{.label = "parameter", .range = {-0.6, static_cast<double>(v.parameters.size()) - 0.4}, .names = {}};
  for (std::size_t k = 0; k < v.parameters.size(); ++k)
    x.names.push_back({static_cast<double>(k), v.parameters[k]});
  Plot plot(drawing, {Plot::kLeft + 4, 22, 820 - Plot::kLeft - 4 - Plot::kRight, 230 - 22 - Plot::kBottom}, x,
            {.label = "standard error, times",
             .range = range_of(all, ScaleKind::log, 0.1),
             .kind = ScaleKind::log});
  plot.rule_y(1, {.stroke = Tone::quiet, .width = 1});
  double most = 1;
  std::string where = "none";
  const double step = 0.7 / static_cast<double>(std::max<std::size_t>(1, v.sensors.size()));
  for (std::size_t s = 0; s < v.sd_ratio.size(); ++s) {
    Series series{.name = v.sensors[s], .tone = sensor_tone(s), .shape = sensor_shape(s)};
    for (std::size_t k = 0; k < v.sd_ratio[s].size(); ++k) {
      series.x.push_back(static_cast<double>(k) + step * (static_cast<double>(s) + 0.5) - 0.35);
      series.y.push_back(v.sd_ratio[s][k]);
      if (v.sd_ratio[s][k] > most) most = v.sd_ratio[s][k], where = v.sensors[s] + "." + v.parameters[k];
    }
    plot.marks(series, 3);
  }
  draw_legend(drawing, {Plot::kLeft + 4, 14}, sensor_legend(v.sensors), 700);
  Figure out{
      .name = "price",
      .title = "What the effects cost: growth of the standard errors",
      .svg = {},
      .caption = "Standard error of each parameter with the effects in the model over that without them.",
      .good = fmt::format(
          "near 1: what is paid for the effects is small against the error that they take out. Here "
          "the largest growth is {} times ({}), and the standard error of the tensor's worst component "
          "goes from {} to {} nT/m.",
          short_number(most), where, short_number(v.tensor_before_nT_per_m),
          short_number(v.tensor_after_nT_per_m)),
      .data = {.head = {"parameter"}, .rows = {}},
      .wide = true};
  for (const std::string& s : v.sensors) out.data.head.push_back(s);
  for (std::size_t k = 0; k < v.parameters.size(); ++k) {
    std::vector<std::string> row{v.parameters[k]};
    for (const auto& sensor : v.sd_ratio) row.push_back(short_number(sensor[k]));
    out.data.rows.push_back(std::move(row));
  }
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

Figure impact_figure(const ImpactValues& v) {
  constexpr double kImpactRow = 22;
  double label = 120, most = 0;
  std::vector<double> all;
  std::string worst = "none";
  const auto rows = static_cast<double>(std::max<std::size_t>(1, v.rows.size()));
  Axis names{.label = "", .range = {-rows + 0.5, 0.5}, .names = {{1e9, ""}}};
  for (std::size_t i = 0; i < v.rows.size(); ++i) {
    const ImpactValues::Row& row = v.rows[i];
    names.names.push_back({-static_cast<double>(i), row.effect});
    label = std::max(label, text_width(row.effect, kFontSize) + 20);
    if (row.shift_nT_per_m > 0) all.push_back(row.shift_nT_per_m);
    if (row.shift_nT_per_m > most) most = row.shift_nT_per_m, worst = row.effect + ", " + row.component;
  }
  if (v.known_nT_per_m > 0) all.push_back(v.known_nT_per_m);
  label = std::min(label, 300.0);
  Range range = range_of(all, ScaleKind::log, 0.12);
  range.from /= 1.5, range.to *= 2;
  Drawing drawing("impact", 820, 24 + kImpactRow * rows + Plot::kBottom);
  Plot plot(drawing, {label, 24, 820 - label - 14, kImpactRow * rows},
            {.label = "shift of the component that moves most, nT/m", .range = range, .kind = ScaleKind::log},
            names);
  plot.rule_x(v.known_nT_per_m, {.stroke = Tone::green, .width = 1.4, .dash = "5 3"});
  for (std::size_t i = 0; i < v.rows.size(); ++i) {
    const ImpactValues::Row& row = v.rows[i];
    const double y = plot.y()(-static_cast<double>(i));
    if (!plot.x().holds(row.shift_nT_per_m)) {
      drawing.text_over({label + 6, y + 4}, "not determined", Anchor::start, Tone::quiet);
      continue;
    }
    const double end = plot.x()(row.shift_nT_per_m);
    drawing.open(
        {.fill = row.shift_nT_per_m > v.known_nT_per_m ? Tone::vermilion : Tone::blue, .opacity = 0.85});
    drawing.rect(label, y - 6, end - label, 12);
    drawing.close();
    drawing.text_over({end + 5, y + 4}, short_number(row.shift_nT_per_m) + " nT/m, " + row.component);
  }
  draw_legend(drawing, {label, 14},
              std::vector{LegendEntry{.name = "standard error of the tensor by the calibration",
                                      .tone = Tone::green,
                                      .line = true,
                                      .dash = "5 3"}},
              820 - label);
  Figure out{
      .name = "impact",
      .title = "What ignoring an effect does to the tensor",
      .svg = {},
      .caption =
          "The parameters take up what they can of an effect that is left out of the model. Shift of the "
          "tensor in "
          "the field of this run, root mean square over all attitudes, of the component that moves most.",
      .good = fmt::format(
          "blue: less than what the calibration does not know anyway. Here the largest shift is {} nT/m ({}) "
          "with a standard error of {} nT/m.",
          short_number(most), worst, short_number(v.known_nT_per_m)),
      .data = {.head = {"effect", "shift, nT/m", "component"}, .rows = {}},
      .wide = true};
  for (const ImpactValues::Row& row : v.rows)
    out.data.rows.push_back({row.effect, short_number(row.shift_nT_per_m), row.component});
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
