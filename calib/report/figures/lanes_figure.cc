// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/lanes_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace mgtd::calib::report::figures {
namespace {

constexpr double kLane = 78, kLaneGap = 12, kNames = 150, kLaneWidth = 650;
constexpr std::size_t kMostLaneRows = 400;

std::vector<double> values_of(const Lane& lane) {
  std::vector<double> out;
  for (const Series& s : lane.series) out.insert(out.end(), s.y.begin(), s.y.end());
  return out;
}

/// Lowest, highest and mean by column of the drawing.
void draw_columns(Plot& plot, const Series& s) {
  constexpr int kColumns = 325;
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> x, low(kColumns, none), high(kColumns, none), sum(kColumns, 0), n(kColumns, 0);
  const Range r = plot.x().range();
  for (int c = 0; c < kColumns; ++c) x.push_back(r.from + (r.to - r.from) * (c + 0.5) / kColumns);
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (!plot.holds(s.x[i], s.y[i])) continue;
    const auto c = static_cast<std::size_t>(
        std::clamp(static_cast<int>((s.x[i] - r.from) / (r.to - r.from) * kColumns), 0, kColumns - 1));
    low[c] = std::fmin(low[c], s.y[i]), high[c] = std::fmax(high[c], s.y[i]);
    sum[c] += s.y[i], n[c] += 1;
  }
  for (std::size_t c = 0; c < sum.size(); ++c) sum[c] /= n[c];  // 0/0: a gap
  plot.band(x, low, high, s.tone, 0.3);
  plot.line(x, sum, {.stroke = s.tone, .width = 1.2});
}

/// A line that is broken where a gap is.
void draw_joined(Plot& plot, const Series& s, const std::vector<Gap>& gaps) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const bool broken = i > 0 && std::any_of(gaps.begin(), gaps.end(), [&](const Gap& g) {
                          return s.x[i - 1] <= g.from_h + 1e-9 && s.x[i] >= g.to_h - 1e-9;
                        });
    if (broken) x.push_back(s.x[i]), y.push_back(std::numeric_limits<double>::quiet_NaN());
    x.push_back(s.x[i]), y.push_back(s.y[i]);
  }
  plot.line(x, y, {.stroke = s.tone, .width = 1.2});
}

void draw_lane(Drawing& drawing, const Box& box, const Lane& lane, const Range& time, bool last,
               const std::vector<Gap>& gaps) {
  std::vector<double> ys = values_of(lane);
  if (lane.limit) ys.push_back(*lane.limit);
  const ScaleKind kind = lane.log ? ScaleKind::log : ScaleKind::linear;
  Plot plot(drawing, box, {.label = last ? "time since the start, h" : "", .range = time, .numbers = last},
            {.label = "", .range = range_of(ys, kind, 0.1), .kind = kind});
  for (const Gap& gap : gaps) {
    const double from = plot.x()(std::max(gap.from_h, time.from)), to = plot.x()(std::min(gap.to_h, time.to));
    if (to > from) drawing.hatch(from, box.y, to - from, box.height);
  }
  if (lane.limit)
    plot.rule_y(*lane.limit, {.stroke = Tone::vermilion, .width = 1.2, .dash = "5 3"}, lane.limit_text);
  for (const Series& s : lane.series) {
    if (s.x.size() > kMostMarks) {
      draw_columns(plot, s);
    } else {
      if (lane.joined) draw_joined(plot, s, gaps);
      plot.marks(s, lane.joined ? 1.3 : 2);
    }
  }
  drawing.text({0, box.y + 11}, lane.name, Anchor::start, Tone::ink, kFontSize, true);
  drawing.text({0, box.y + 25}, lane.unit, Anchor::start, Tone::quiet);
  double y = box.y + 40;
  for (const Series& s : lane.series) {
    if (lane.series.size() < 2 || y > box.y + box.height + 6) break;
    draw_legend(drawing, {0, y}, std::vector{LegendEntry{.name = s.name, .tone = s.tone, .shape = s.shape}},
                kNames - 60);
    y += 12;
  }
}

}  // namespace

Figure lanes_figure(const LanesValues& v) {
  std::vector<double> times;
  for (const Lane& lane : v.lanes)
    for (const Series& s : lane.series) times.insert(times.end(), s.x.begin(), s.x.end());
  const Range time = range_of(times, ScaleKind::linear, 0.01);
  const auto n = static_cast<double>(std::max<std::size_t>(1, v.lanes.size()));
  Drawing drawing(v.name, 820, 8 + n * (kLane + kLaneGap) + Plot::kBottom - kLaneGap);
  for (std::size_t i = 0; i < v.lanes.size(); ++i)
    draw_lane(drawing, {kNames, 8 + static_cast<double>(i) * (kLane + kLaneGap), kLaneWidth, kLane},
              v.lanes[i], time, i + 1 == v.lanes.size(), v.gaps);
  Figure out{.name = v.name,
             .title = v.title,
             .svg = {},
             .caption = v.what,
             .good = v.good,
             .data = {},
             .wide = true};
  if (!v.gaps.empty()) {
    out.caption += " Hatched: ";
    for (std::size_t i = 0; i < v.gaps.size() && i < 3; ++i)
      out.caption += fmt::format("{}{:.2f} to {:.2f} h, {}", i == 0 ? "" : "; ", v.gaps[i].from_h,
                                 v.gaps[i].to_h, v.gaps[i].why);
    out.caption += v.gaps.size() > 3 ? fmt::format("; {} more.", v.gaps.size() - 3) : ".";
  }
  out.data.head = {"lane", "time, h", "value"};
  for (const Lane& lane : v.lanes) {
    for (const Series& s : lane.series) {
      const std::size_t every = 1 + s.x.size() / kMostLaneRows;
      if (every > 1) out.data.note = "Of thousands of values, every so many.";
      for (std::size_t i = 0; i < s.x.size(); i += every)
        out.data.rows.push_back({lane.series.size() > 1 ? lane.name + ", " + s.name : lane.name,
                                 fmt::format("{:.4f}", s.x[i]), short_number(s.y[i])});
    }
  }
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
