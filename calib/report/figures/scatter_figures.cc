// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/scatter_figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/report/figures/plot.h"

namespace mgtd::calib::report::figures {
namespace {

constexpr double kWide = 820, kNarrow = 410, kTall = 258, kHeadLine = 24, kGap = 24;

double half_width(bool pair) {
  return pair ? (kWide - Plot::kLeft - Plot::kRight - kGap) / 2 : kNarrow - Plot::kLeft - Plot::kRight;
}

std::size_t outside(const QqView& v) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < v.residual.size(); ++i)
    if (v.residual[i] < v.low[i] || v.residual[i] > v.high[i]) ++out;
  return out;
}

/// The tails whole, of the middle as many as can be told apart.
std::vector<std::size_t> shown_of(const QqView& v) {
  constexpr double kTail = 1.6;
  constexpr std::size_t kMiddle = 120;
  const std::size_t every = std::max<std::size_t>(1, v.quantile.size() / kMiddle);
  const std::size_t every_tail = std::max<std::size_t>(1, v.quantile.size() / 4000);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < v.quantile.size(); ++i)
    if (i < 20 || i + 20 >= v.quantile.size() || i % every == 0 ||
        (std::abs(v.quantile[i]) > kTail && i % every_tail == 0))
      out.push_back(i);
  return out;
}

void draw_qq(Drawing& drawing, const Box& box, const QqView& v, const Axis& x, const Axis& y) {
  Plot plot(drawing, box, x, y);
  std::vector<double> quantile, low, high;
  for (const std::size_t i : shown_of(v))
    quantile.push_back(v.quantile[i]), low.push_back(v.low[i]), high.push_back(v.high[i]);
  plot.band(quantile, low, high, Tone::grey, 0.25);
  plot.line(std::vector{x.range.from, x.range.to}, std::vector{x.range.from, x.range.to},
            {.stroke = Tone::quiet});
  Series in, off;
  off.tone = Tone::vermilion;
  for (const std::size_t i : shown_of(v)) {
    Series& s = v.residual[i] < v.low[i] || v.residual[i] > v.high[i] ? off : in;
    s.x.push_back(v.quantile[i]), s.y.push_back(v.residual[i]);
  }
  plot.marks(in, 2);
  plot.marks(off, 2);
}

DataTable qq_table(const QqValues& v) {
  DataTable out{.head = {"quantile", "residual", "envelope from", "to"},
                .rows = {},
                .note = "The points that are drawn."};
  if (!v.after.quantile.empty()) out.head.push_back("with the effects");
  for (const std::size_t i : shown_of(v.before)) {
    out.rows.push_back({short_number(v.before.quantile[i]), short_number(v.before.residual[i]),
                        short_number(v.before.low[i]), short_number(v.before.high[i])});
    if (!v.after.quantile.empty())
      out.rows.back().push_back(i < v.after.residual.size() ? short_number(v.after.residual[i]) : "");
  }
  return out;
}

void draw_lags(Drawing& drawing, const Box& box, const AutocorrelationValues& v,
               const std::vector<std::vector<double>>& lags, const Axis& x, const Axis& y) {
  Plot plot(drawing, box, x, y);
  drawing.open({.fill = Tone::grey, .opacity = 0.25});
  drawing.rect(box.x, plot.y()(v.bound), box.width, plot.y()(-v.bound) - plot.y()(v.bound));
  drawing.close();
  plot.rule_y(0, {.stroke = Tone::quiet});
  const double step = plot.x()(2) - plot.x()(1), bar = 0.8 * step / static_cast<double>(lags.size());
  for (std::size_t s = 0; s < lags.size(); ++s) {
    drawing.open({.fill = sensor_tone(s)});
    for (std::size_t k = 0; k < lags[s].size(); ++k) {
      if (!std::isfinite(lags[s][k])) continue;
      const double left = plot.x()(static_cast<double>(k + 1)) - 0.4 * step + bar * static_cast<double>(s);
      const double top = plot.y()(std::max(0.0, lags[s][k])), foot = plot.y()(std::min(0.0, lags[s][k]));
      drawing.rect(left, top, std::max(0.6, bar - 0.3), foot - top);
    }
    drawing.close();
  }
}

std::string lags_off(const std::vector<std::vector<double>>& lags, double bound) {
  std::size_t off = 0, all = 0;
  double first = 0;
  for (const auto& sensor : lags) {
    if (!sensor.empty() && std::abs(sensor.front()) > std::abs(first)) first = sensor.front();
    for (const double r : sensor) ++all, off += std::abs(r) > bound ? 1U : 0U;
  }
  return fmt::format("{} of {} bars leave the band, lag 1 is at most {:+.2f}", off, all, first);
}

}  // namespace

Figure qq_figure(const QqValues& v) {
  const bool pair = !v.after.residual.empty();
  std::vector<double> ys, xs;
  for (const QqView* view : {&v.before, &v.after}) {
    ys.insert(ys.end(), view->residual.begin(), view->residual.end());
    xs.insert(xs.end(), view->quantile.begin(), view->quantile.end());
  }
  const Axis x{.label = "normal quantile", .range = symmetric_range_of(xs)};
  const Axis y{.label = "residual, in units of its noise", .range = symmetric_range_of(ys)};
  const double each = half_width(pair), height = kTall - kHeadLine - Plot::kBottom;
  Drawing drawing("qq", pair ? kWide : kNarrow, kTall);
  draw_qq(drawing, {Plot::kLeft, kHeadLine, each, height}, v.before, x, y);
  if (pair) {
    Axis bare = y;
    bare.label.clear(), bare.numbers = false;
    draw_qq(drawing, {Plot::kLeft + each + kGap, kHeadLine, each, height}, v.after, x, bare);
    drawing.text({Plot::kLeft, 14}, "without effects", Anchor::start, Tone::ink, kFontSize, true);
    drawing.text({Plot::kLeft + each + kGap, 14}, "with the effects", Anchor::start, Tone::ink, kFontSize,
                 true);
  }
  Figure out{
      .name = "qq",
      .title = "Are the residuals normal?",
      .svg = {},
      .caption =
          "All residuals in order against the quantiles of the normal distribution. In 95 of 100 runs of "
          "pure noise all points lie in the grey band; orange points do not.",
      .good = fmt::format("all points in the band, along the line. Here {} of the {} drawn, of {} in all, "
                          "lie outside it{}; {} readings "
                          "were left out by the fit and are not among them.",
                          outside(v.before), v.before.residual.size(),
                          std::max(v.before.n, v.before.residual.size()),
                          pair ? fmt::format(", with the effects {}", outside(v.after)) : "", v.left_out),
      .data = qq_table(v),
      .wide = pair};
  out.stands_out = outside(pair ? v.after : v.before) > 0;
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

Figure autocorrelation_figure(const AutocorrelationValues& v) {
  const bool pair = !v.after.empty();
  std::vector<double> all{v.bound * 1.5};
  std::size_t lags = 1;
  for (const auto* set : {&v.before, &v.after})
    for (const auto& sensor : *set)
      all.insert(all.end(), sensor.begin(), sensor.end()), lags = std::max(lags, sensor.size());
  const Axis x{.label = "lag, poses", .range = {0.4, static_cast<double>(lags) + 0.6}};
  const Axis y{.label = "correlation", .range = symmetric_range_of(all)};
  const double each = half_width(pair), height = kTall - kHeadLine - Plot::kBottom;
  Drawing drawing("autocorrelation", pair ? kWide : kNarrow, kTall);
  draw_lags(drawing, {Plot::kLeft, kHeadLine, each, height}, v, v.before, x, y);
  std::vector<LegendEntry> legend;
  for (std::size_t s = 0; s < v.sensors.size(); ++s)
    legend.push_back({.name = v.sensors[s], .tone = sensor_tone(s), .shape = Shape::square});
  if (pair) {
    Axis bare = y;
    bare.label.clear(), bare.numbers = false;
    draw_lags(drawing, {Plot::kLeft + each + kGap, kHeadLine, each, height}, v, v.after, x, bare);
    drawing.text({Plot::kLeft, 14}, "without effects", Anchor::start, Tone::ink, kFontSize, true);
    drawing.text({Plot::kLeft + each + kGap, 14}, "with the effects", Anchor::start, Tone::ink, kFontSize,
                 true);
    draw_legend(drawing, {Plot::kLeft + each + 14 - legend_width(legend), 14}, legend, each);
  } else {
    draw_legend(drawing, {Plot::kLeft, 14}, legend, each);
  }
  Figure out{
      .name = "autocorrelation",
      .title = "Does a pose remember the ones before?",
      .svg = {},
      .caption =
          "Correlation of each sensor's residual with that some poses earlier. Of pure noise 95 of 100 "
          "bars end in the grey band.",
      .good = fmt::format(
          "bars in the band, without a slow decay. Here {}{}. The tests allow for a correlation "
          "of {:.2f} from one pose to the next.",
          lags_off(v.before, v.bound), pair ? "; with the effects " + lags_off(v.after, v.bound) : "", v.rho),
      .data = {.head = {"lag"}, .rows = {}},
      .wide = pair};
  for (const auto* set : {&v.before, &v.after})
    for (std::size_t s = 0; s < set->size(); ++s)
      out.data.head.push_back(v.sensors[s] + (set == &v.before ? "" : ", with the effects"));
  for (std::size_t k = 0; k < lags; ++k) {
    std::vector<std::string> row{fmt::format("{}", k + 1)};
    for (const auto* set : {&v.before, &v.after})
      for (const auto& sensor : *set)
        row.push_back(k < sensor.size() ? fmt::format("{:+.3f}", sensor[k]) : "");
    out.data.rows.push_back(std::move(row));
  }
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

Figure evidence_figure(const EvidenceValues& v) {
  Drawing drawing(v.name, kWide, 300);
  std::vector<double> ys = v.y;
  ys.push_back(0);
  std::vector<double> xs = v.x;
  xs.push_back(0);
  const Axis x{.label = v.x_label, .range = range_of(xs)}, y{.label = v.y_label, .range = range_of(ys)};
  Plot plot(drawing,
            {Plot::kLeft, kHeadLine, kWide - Plot::kLeft - Plot::kRight, 300 - kHeadLine - Plot::kBottom}, x,
            y);
  plot.rule_y(0, {.stroke = Tone::quiet});
  std::vector<double> along, low, high, middle;
  double squares = 0;
  for (const double each : v.x) squares += std::isfinite(each) ? each * each : 0;
  constexpr int kSteps = 40;
  for (int i = 0; i <= kSteps; ++i) {
    const double at = x.range.from + (x.range.to - x.range.from) * i / kSteps;
    along.push_back(at), middle.push_back(v.slope * at);
    low.push_back(v.slope * at - 2 * v.slope_sd * std::abs(at)),
        high.push_back(v.slope * at + 2 * v.slope_sd * std::abs(at));
  }
  plot.band(along, low, high, Tone::vermilion, 0.25);
  const Series points{.name = "a pose", .x = v.x, .y = v.y, .poses = v.poses, .tone = Tone::blue};
  plot.points(std::vector{points});
  plot.line(along, middle, {.stroke = Tone::vermilion, .width = 1.8});
  std::vector<std::string> ringed;
  if (v.x.size() <= kMostMarks) {
    drawing.open({.stroke = Tone::ink, .width = 1});
    for (std::size_t i = 0; i < v.x.size(); ++i) {
      const double lever = squares > 0 ? v.x[i] * v.x[i] / squares : 0;
      if (!(lever > 4.0 / static_cast<double>(v.x.size())) || !plot.holds(v.x[i], v.y[i])) continue;
      drawing.ellipse(plot.at(v.x[i], v.y[i]), 5, 5);
      if (i < v.poses.size()) ringed.push_back(fmt::format("{}", v.poses[i]));
    }
    drawing.close();
  }
  drawing.text({Plot::kLeft, 14}, fmt::format("slope {}", v.slope_text), Anchor::start, Tone::vermilion,
               kFontSize, true);
  Figure out{
      .name = v.name,
      .title = fmt::format("The evidence for {}{}{}", v.effect, v.where.empty() ? "" : " at ", v.where),
      .svg = {},
      .caption =
          "What the effect would make of each pose, and what the model leaves there; calibration, "
          "attitude and field are taken out of both. The slope of the line is the coefficient, its band "
          "two standard errors. A ring: the pose has more than four times its share of leverage.",
      .good =
          fmt::format("a line through many points, not one point with leverage. Here the slope is {}; the "
                      "pose that counts most carries {:.0f} % of the evidence, and {} poses are ringed.",
                      v.slope_text, 100 * v.largest_share, ringed.size()),
      .data = {.head = {"pose", v.x_label, v.y_label}, .rows = {}},
      .wide = true};
  for (std::size_t i = 0; i < v.x.size() && v.x.size() <= kMostMarks; ++i)
    out.data.rows.push_back({i < v.poses.size() ? fmt::format("{}", v.poses[i]) : "", short_number(v.x[i]),
                             short_number(v.y[i])});
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
