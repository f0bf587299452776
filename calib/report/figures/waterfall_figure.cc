// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/waterfall_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/report/figures/plot.h"
#include "calib/report/figures/text_width.h"

namespace mgtd::calib::report::figures {
namespace {

constexpr double kRow = 17, kHeadRoom = 34;

/// A bar of the fall: between two errors.
struct Fall {
  std::string name;
  double from{0}, to{0};
  Tone tone{Tone::grey};
  std::string text;
};

double less(double whole, double part) { return std::sqrt(std::max(0.0, whole * whole - part * part)); }

constexpr double kMostLabel = 270, kLabelGap = 20;

std::string label_of(const WaterfallValues& v, std::size_t i) {
  const bool fits = text_width(v.effects[i], kFontSize) + kLabelGap <= kMostLabel;
  return fits || v.short_names.empty() ? v.effects[i] : v.short_names[i];
}

std::vector<Fall> falls_of(const WaterfallValues& v, const FallValues& f) {
  std::vector<Fall> out;
  out.push_back({"without any effect", f.without, f.without, Tone::grey, short_number(f.without)});
  for (std::size_t i = 0; i < v.effects.size(); ++i) {
    const double missing = std::hypot(f.with, f.last_share[i]);
    out.push_back({label_of(v, i), f.without, less(f.without, f.first_share[i]), Tone::blue,
                   short_number(f.first_share[i])});
    out.push_back({"", missing, f.with, Tone::vermilion, short_number(f.last_share[i])});
  }
  out.push_back({"with all of them", f.with, f.with, Tone::grey, short_number(f.with)});
  return out;
}

void draw_falls(Drawing& drawing, const Box& box, const FallValues& f, const std::vector<Fall>& falls,
                bool names) {
  std::vector<double> levels{f.without, f.with, f.floor, f.held_out.value_or(f.with)};
  for (const Fall& fall : falls) levels.insert(levels.end(), {fall.from, fall.to});
  Range range = range_of(levels, ScaleKind::log, 0.12);
  // Room at the right for the number of the first bar.
  range.to *= std::pow(range.to / range.from, 0.12);
  const auto n = static_cast<double>(falls.size());
  Axis rows{.label = "", .range = {-n + 0.5, 0.5}, .names = {}};
  for (std::size_t i = 0; names && i < falls.size(); ++i)
    if (!falls[i].name.empty())
      rows.names.push_back(
          {-static_cast<double>(i) - (falls[i].tone == Tone::grey ? 0 : 0.5), falls[i].name});
  if (!names) rows.names.push_back({1e9, ""});
  Plot plot(drawing, box, {.label = f.unit, .range = range, .kind = ScaleKind::log}, rows);
  plot.rule_x(f.floor, {.stroke = Tone::green, .width = 1.4, .dash = "5 3"});
  if (f.held_out) plot.rule_x(*f.held_out, {.stroke = Tone::purple, .width = 1.4, .dash = "1.5 2.5"});
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const Fall& fall = falls[i];
    const double y = plot.y()(-static_cast<double>(i)), right = plot.x()(std::max(fall.from, fall.to));
    const double left =
        fall.tone == Tone::grey ? box.x : plot.x()(std::max(range.from, std::min(fall.from, fall.to)));
    drawing.open({.fill = fall.tone, .opacity = fall.tone == Tone::grey ? 0.45 : 0.9});
    drawing.rect(left, y - kRow * 0.36, std::max(1.0, right - left), kRow * 0.72);
    drawing.close();
    const bool outside = right + 5 + text_width(fall.text, kFontSize) < box.x + box.width;
    drawing.text_over({outside ? right + 4 : left - 4, y + 4}, fall.text,
                      outside ? Anchor::start : Anchor::end);
  }
}

std::string said(const FallValues& f) {
  std::string out = fmt::format("it ends at {} {} with a noise of {} {}", short_number(f.with), f.unit,
                                short_number(f.floor), f.unit);
  if (f.held_out)
    out +=
        fmt::format(", and at {} {} on poses that the fit has not seen", short_number(*f.held_out), f.unit);
  return out;
}

DataTable table_of(const WaterfallValues& v) {
  DataTable out{.head = {"effect"}, .rows = {}, .note = "Shares add in squares."};
  std::vector<const FallValues*> errors{&v.residual};
  if (v.tensor) errors.push_back(&*v.tensor);
  for (const FallValues* f : errors)
    for (const char* order : {"added first", "dropped last"})
      out.head.push_back(fmt::format("{}, {}", order, f->unit));
  const auto level = [&](const std::string& name, double FallValues::*of) {
    std::vector<std::string>& row = out.rows.emplace_back(std::vector<std::string>{name});
    for (const FallValues* f : errors) row.insert(row.end(), {short_number(f->*of), ""});
  };
  level("error without any", &FallValues::without);
  for (std::size_t i = 0; i < v.effects.size(); ++i) {
    std::vector<std::string>& row = out.rows.emplace_back(std::vector<std::string>{v.effects[i]});
    for (const FallValues* f : errors)
      row.insert(row.end(), {short_number(f->first_share[i]), short_number(f->last_share[i])});
  }
  level("error with all", &FallValues::with);
  level("noise", &FallValues::floor);
  return out;
}

}  // namespace

Figure waterfall_figure(const WaterfallValues& v) {
  double label = 130;
  for (std::size_t i = 0; i < v.effects.size(); ++i)
    label = std::max(label, text_width(label_of(v, i), kFontSize) + kLabelGap);
  label = std::min(label, kMostLabel);
  const std::vector<Fall> left = falls_of(v, v.residual);
  const double height = kRow * static_cast<double>(left.size()), each = (820 - label - 30) / 2;
  Drawing drawing("waterfall", 820, kHeadRoom + height + Plot::kBottom + 4);
  draw_falls(drawing, {label, kHeadRoom, each, height}, v.residual, left, true);
  if (v.tensor)
    draw_falls(drawing, {label + each + 20, kHeadRoom, each, height}, *v.tensor, falls_of(v, *v.tensor),
               false);
  drawing.text({label, 27}, "residual of the readings", Anchor::start, Tone::ink, kFontSize, true);
  if (v.tensor)
    drawing.text({label + each + 20, 27}, "error of the tensor", Anchor::start, Tone::ink, kFontSize, true);
  std::vector<LegendEntry> legend{{.name = "added first", .tone = Tone::blue, .shape = Shape::square},
                                  {.name = "dropped last", .tone = Tone::vermilion, .shape = Shape::square},
                                  {.name = "noise", .tone = Tone::green, .line = true, .dash = "5 3"}};
  if (v.residual.held_out || (v.tensor && v.tensor->held_out))
    legend.push_back({.name = "on poses left out", .tone = Tone::purple, .line = true, .dash = "1.5 2.5"});
  draw_legend(drawing, {label, 12}, legend, 820 - label);
  Figure out{
      .name = "waterfall",
      .title = "What each effect takes out of the error",
      .svg = {},
      .caption =
          "Blue: the fall when the effect is added first, to the sensors' parameters alone. Orange: the "
          "fall when it is added last, to all the others. Numbers are shares; shares add in squares.",
      .good = "the last bar ends at the dashed line, and the poses left out agree. Here " + said(v.residual) +
              ". Where the two bars of an effect differ in length, it shares what it explains with another.",
      .data = table_of(v),
      .wide = true};
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
