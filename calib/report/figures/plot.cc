// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/report/figures/text_width.h"

namespace mgtd::calib::report::figures {
namespace {

Ticks ticks_for(const Axis& axis, const Scale& scale, int about) {
  if (!axis.names.empty()) {
    Ticks out;
    for (const Tick& t : axis.names)
      if (scale.holds(t.value)) out.ticks.push_back(t);
    return out;
  }
  return axis.angle_deg ? angle_ticks_of(scale.range(), about) : ticks_of(scale.range(), scale.kind(), about);
}

std::string label_with_power(const std::string& label, int power) {
  return power == 0 ? label : label + " " + power_label(power);
}

}  // namespace

Plot::Plot(Drawing& drawing, const Box& box, const Axis& x, const Axis& y)
    : drawing_(drawing),
      box_(box),
      x_(x.range, box.x, box.x + box.width, x.kind),
      y_(y.range, box.y + box.height, box.y, y.kind) {
  draw_x_axis(x);
  draw_y_axis(y);
  drawing_.open({.stroke = Tone::quiet, .width = 0.8});
  drawing_.polyline({{box.x, box.y}, {box.x, box.y + box.height}, {box.x + box.width, box.y + box.height}});
  drawing_.close();
}

void Plot::draw_x_axis(const Axis& axis) {
  const double foot = box_.y + box_.height;
  const Ticks ticks = ticks_for(axis, x_, std::max(2, static_cast<int>(box_.width / 60)));
  drawing_.open({.stroke = Tone::rule, .width = 0.8});
  for (const Tick& t : ticks.ticks)
    if (!t.label.empty() && axis.names.empty()) drawing_.line({x_(t.value), box_.y}, {x_(t.value), foot});
  drawing_.close();
  drawing_.open({.stroke = Tone::quiet, .width = 0.8});
  for (const Tick& t : ticks.ticks)
    drawing_.line({x_(t.value), foot}, {x_(t.value), foot + (t.label.empty() ? 2.5 : 4)});
  drawing_.close();
  double free_from = -1e9;
  for (const Tick& t : ticks.ticks) {
    const double half = text_width(t.label, kFontSize) / 2;
    if (!axis.numbers || t.label.empty() || x_(t.value) - half < free_from) continue;
    drawing_.text({x_(t.value), foot + 15}, t.label, Anchor::middle, Tone::quiet);
    free_from = x_(t.value) + half + 5;
  }
  if (!axis.label.empty())
    drawing_.text({box_.x + box_.width / 2, foot + 30}, label_with_power(axis.label, ticks.power),
                  Anchor::middle);
}

void Plot::draw_y_axis(const Axis& axis) {
  const Ticks ticks = ticks_for(axis, y_, std::max(2, static_cast<int>(box_.height / 28)));
  drawing_.open({.stroke = Tone::rule, .width = 0.8});
  for (const Tick& t : ticks.ticks)
    if (!t.label.empty() && axis.names.empty())
      drawing_.line({box_.x, y_(t.value)}, {box_.x + box_.width, y_(t.value)});
  drawing_.close();
  drawing_.open({.stroke = Tone::quiet, .width = 0.8});
  for (const Tick& t : ticks.ticks)
    drawing_.line({box_.x - (t.label.empty() ? 2.5 : 4), y_(t.value)}, {box_.x, y_(t.value)});
  drawing_.close();
  double widest = 0;
  for (const Tick& t : ticks.ticks) {
    if (!axis.numbers || t.label.empty()) continue;
    const std::string_view whole = t.label, part = fitting_part(whole, kFontSize, box_.x - 18);
    drawing_.text({box_.x - 7, y_(t.value) + 4},
                  part.size() < whole.size() ? std::string(part) + "…" : t.label, Anchor::end,
                  axis.names.empty() ? Tone::quiet : Tone::ink);
    widest = std::max(widest, text_width(t.label, kFontSize));
  }
  if (!axis.label.empty())
    drawing_.text_up({std::max(11.0, box_.x - 14 - widest), box_.y + box_.height / 2},
                     label_with_power(axis.label, ticks.power));
}

void Plot::marks(const Series& s, double radius) {
  if (!s.sd.empty()) {
    drawing_.open({.stroke = s.tone, .width = 0.9});
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!holds(s.x[i], s.y[i]) || !std::isfinite(s.sd[i])) continue;
      const Range r = y_.range();
      const double low = std::clamp(s.y[i] - s.sd[i], r.from, r.to),
                   high = std::clamp(s.y[i] + s.sd[i], r.from, r.to);
      drawing_.line(at(s.x[i], low), at(s.x[i], high));
    }
    drawing_.close();
  }
  for (const bool hollow : {false, true}) {
    if (hollow && std::find(s.hollow.begin(), s.hollow.end(), true) == s.hollow.end()) continue;
    const bool cross = s.shape == Shape::cross;
    drawing_.open(
        hollow || cross ? Style{.stroke = s.tone, .width = 1.2} : Style{.fill = s.tone, .opacity = 0.85},
        "marks");
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!holds(s.x[i], s.y[i]) || (!s.hollow.empty() && s.hollow[i]) != hollow) continue;
      drawing_.mark(s.shape, at(s.x[i], s.y[i]), radius, s.poses.empty() ? -1 : s.poses[i]);
    }
    drawing_.close();
  }
}

void Plot::points(std::span<const Series> all, double radius) {
  std::size_t n = 0;
  for (const Series& s : all) n += s.x.size();
  if (n > kMostMarks) return density(all);
  for (const Series& s : all) marks(s, radius);
}

void Plot::line(std::span<const double> x, std::span<const double> y, const Style& style) {
  drawing_.open(style);
  std::vector<Place> part;
  for (std::size_t i = 0; i <= x.size(); ++i) {
    const bool here = i < x.size() && std::isfinite(x[i]) && std::isfinite(y[i]) &&
                      (y_.kind() == ScaleKind::linear || y[i] > 0) &&
                      (x_.kind() == ScaleKind::linear || x[i] > 0);
    if (here) {
      part.push_back(at(x[i], y[i]));
      continue;
    }
    drawing_.polyline_within(part, box_.x, box_.y, box_.width, box_.height);
    part.clear();
  }
  drawing_.close();
}

void Plot::band(std::span<const double> x, std::span<const double> low, std::span<const double> high,
                Tone tone, double opacity) {
  std::vector<Place> around;
  const auto inside = [&](double v) { return std::clamp(v, y_.range().from, y_.range().to); };
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x_.holds(x[i]) && std::isfinite(low[i]) && std::isfinite(high[i]))
      around.push_back(at(x[i], inside(low[i])));
  for (std::size_t i = x.size(); i-- > 0;)
    if (x_.holds(x[i]) && std::isfinite(low[i]) && std::isfinite(high[i]))
      around.push_back(at(x[i], inside(high[i])));
  drawing_.open({.fill = tone, .opacity = opacity});
  drawing_.polygon(around);
  drawing_.close();
}

void Plot::rule_y(double y, const Style& style, const std::string& label) {
  if (!y_.holds(y)) return;
  drawing_.open(style);
  drawing_.line({box_.x, y_(y)}, {box_.x + box_.width, y_(y)});
  drawing_.close();
  if (label.empty()) return;
  const bool below = y_(y) < box_.y + 16;
  drawing_.text_over({box_.x + box_.width - 4, y_(y) + (below ? 13 : -5)}, label, Anchor::end, style.stroke);
}

void Plot::rule_x(double x, const Style& style, const std::string& label) {
  if (!x_.holds(x)) return;
  drawing_.open(style);
  drawing_.line({x_(x), box_.y}, {x_(x), box_.y + box_.height});
  drawing_.close();
  if (label.empty()) return;
  const bool right = x_(x) + 8 + text_width(label, kFontSize) < box_.x + box_.width;
  drawing_.text_over({x_(x) + (right ? 5 : -5), box_.y + 11}, label, right ? Anchor::start : Anchor::end,
                     style.stroke);
}

void Plot::means(std::span<const double> x, std::span<const double> mean, std::span<const double> se,
                 Tone tone) {
  const Range r = y_.range();
  drawing_.open({.stroke = Tone::paper, .width = 3});
  for (const bool halo : {true, false}) {
    if (!halo) {
      drawing_.close();
      drawing_.open({.stroke = tone, .width = 1.8}, "means");
    }
    std::vector<Place> along;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!x_.holds(x[i]) || !std::isfinite(mean[i])) continue;
      const auto inside = [&](double v) { return std::clamp(v, r.from, r.to); };
      along.push_back(at(x[i], inside(mean[i])));
      if (std::isfinite(se[i]))
        drawing_.line(at(x[i], inside(mean[i] - 2 * se[i])), at(x[i], inside(mean[i] + 2 * se[i])));
    }
    drawing_.polyline(along);
  }
  drawing_.close();
}

void Plot::message(const std::string& text) {
  drawing_.text({box_.x + box_.width / 2, box_.y + box_.height / 2}, text, Anchor::middle, Tone::quiet);
}

double legend_width(std::span<const LegendEntry> entries) {
  double out = 0;
  for (const LegendEntry& e : entries) out += (e.line ? 24 : 12) + text_width(e.name, kFontSize) + 14;
  return out;
}

void draw_legend(Drawing& drawing, Place at, std::span<const LegendEntry> entries, double width) {
  const double end = at.x + width;
  for (const LegendEntry& e : entries) {
    const double needed = legend_width(std::span(&e, 1));
    if (at.x + needed > end + 14) return;
    const bool outline = e.line || e.shape == Shape::cross;
    drawing.open(outline ? Style{.stroke = e.tone, .width = 1.6, .dash = e.dash} : Style{.fill = e.tone});
    if (e.line) {
      drawing.line({at.x, at.y - 4}, {at.x + 18, at.y - 4});
    } else {
      drawing.mark(e.shape, {at.x + 4, at.y - 4}, 3.2);
    }
    drawing.close();
    drawing.text({at.x + (e.line ? 23 : 11), at.y}, e.name);
    at.x += needed;
  }
}

Tone sensor_tone(std::size_t sensor) {
  static constexpr std::array kTonesOfSensors{Tone::blue,   Tone::vermilion, Tone::green,
                                              Tone::purple, Tone::amber,     Tone::sky};
  return kTonesOfSensors[sensor % kTonesOfSensors.size()];
}

Shape sensor_shape(std::size_t sensor) {
  static constexpr std::array kShapes{Shape::circle, Shape::square, Shape::triangle, Shape::diamond};
  return kShapes[sensor % kShapes.size()];
}

}  // namespace mgtd::calib::report::figures
