// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/sky_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/report/figures/plot.h"
#include "calib/report/figures/sky.h"

namespace mgtd::calib::report::figures {
namespace {

constexpr double kDeg = std::numbers::pi / 180;
constexpr std::size_t kMostSkyMarks = 600;
constexpr int kCellRows = 12, kCellColumns = 24;

/// A map of half width `a` about a place.
struct Map {
  Place middle;
  double a;
  [[nodiscard]] Place at(const SkyPoint& p) const {
    return {middle.x + a * p.x / kSkyHalfWidth, middle.y - a * p.y / kSkyHalfWidth};
  }
};

void draw_graticule(Drawing& drawing, const Map& map, bool labels) {
  drawing.open({.stroke = Tone::rule, .width = 0.8});
  for (int longitude = -120; longitude <= 120; longitude += 60) {
    std::vector<Place> along;
    for (int latitude = -90; latitude <= 90; latitude += 5)
      along.push_back(map.at(sky_point(longitude * kDeg, latitude * kDeg)));
    drawing.polyline(along);
  }
  for (int latitude = -60; latitude <= 60; latitude += 30)
    drawing.line(map.at(sky_point(-180 * kDeg, latitude * kDeg)),
                 map.at(sky_point(180 * kDeg, latitude * kDeg)));
  drawing.close();
  drawing.open({.stroke = Tone::quiet, .width = 1});
  drawing.ellipse(map.middle, map.a, map.a / 2);
  drawing.close();
  if (!labels) return;
  const double foot = map.middle.y + map.a / 2 + 13;
  drawing.text({map.middle.x, foot}, "+x", Anchor::middle, Tone::quiet, 10);
  drawing.text({map.at(sky_point(90 * kDeg, 0)).x, foot - map.a * 0.07}, "+y", Anchor::middle, Tone::quiet,
               10);
  drawing.text({map.at(sky_point(-90 * kDeg, 0)).x, foot - map.a * 0.07}, "−y", Anchor::middle, Tone::quiet,
               10);
  drawing.text({map.middle.x, map.middle.y - map.a / 2 - 4}, "+z", Anchor::middle, Tone::quiet, 10);
}

/// Eight steps from nothing to the whole colour, by sign.
constexpr int kShades = 8;
int shade_of(double value, double limit) {
  return std::clamp(static_cast<int>(std::lround(kShades * std::abs(value) / limit)), 0, kShades);
}
Style shade(int step, bool positive) {
  if (step == 0) return {.fill = Tone::grey, .opacity = 0.25};
  return {.fill = positive ? Tone::vermilion : Tone::blue, .opacity = 0.15 + 0.85 * step / kShades};
}

template <typename Draw>
void by_shade(Drawing& drawing, const std::vector<double>& values, double limit, Draw draw) {
  for (const bool positive : {false, true}) {
    for (int step = positive ? 1 : 0; step <= kShades; ++step) {
      bool open = false;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i]) || shade_of(values[i], limit) != step) continue;
        if (step > 0 && (values[i] > 0) != positive) continue;
        if (!open) drawing.open(shade(step, positive), "marks");
        open = true;
        draw(i);
      }
      if (open) drawing.close();
    }
  }
}

/// Means over the cells; NaN where no direction lies.
std::vector<double> cell_means(const std::vector<Eigen::Vector3d>& directions,
                               const std::vector<double>& values) {
  constexpr auto kCells = static_cast<std::size_t>(kCellRows * kCellColumns);
  std::vector<double> sums(kCells, 0), counts(kCells, 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || !(directions[i].norm() > 0)) continue;
    const std::size_t cell = sky_cell_of(directions[i], kCellRows, kCellColumns);
    sums[cell] += values[i], counts[cell] += 1;
  }
  for (std::size_t i = 0; i < kCells; ++i) sums[i] /= counts[i];  // 0/0: NaN
  return sums;
}

std::vector<Place> outline(const Map& map, const SkyCell& c) {
  std::vector<Place> out;
  constexpr int kSteps = 3;
  for (int i = 0; i <= kSteps; ++i)
    out.push_back(map.at(sky_point(
        c.from_longitude_rad, c.from_latitude_rad + (c.to_latitude_rad - c.from_latitude_rad) * i / kSteps)));
  for (int i = kSteps; i >= 0; --i)
    out.push_back(map.at(sky_point(
        c.to_longitude_rad, c.from_latitude_rad + (c.to_latitude_rad - c.from_latitude_rad) * i / kSteps)));
  return out;
}

void draw_sky(Drawing& drawing, const Map& map, const Sky& sky, const std::vector<double>& values,
              double limit) {
  draw_graticule(drawing, map, true);
  if (values.size() > kMostSkyMarks) {
    const std::vector<double> means = cell_means(sky.directions, values);
    const std::vector<SkyCell> cells = sky_cells(kCellRows, kCellColumns);
    by_shade(drawing, means, limit, [&](std::size_t i) { drawing.polygon(outline(map, cells[i])); });
    return;
  }
  by_shade(drawing, values, limit, [&](std::size_t i) {
    const SkyPoint p = sky_point(sky.directions[i]);
    if (std::isfinite(p.x))
      drawing.mark(Shape::circle, map.at(p), 3, i < sky.poses.size() ? sky.poses[i] : -1);
  });
}

/// The magnitude that 98 of 100 values stay below.
double limit_of(const SkiesValues& v) {
  std::vector<double> sizes;
  for (const Sky& sky : v.skies)
    for (const auto* values : {&sky.residual_nT, &sky.after_nT})
      for (const double x : *values)
        if (std::isfinite(x)) sizes.push_back(std::abs(x));
  if (sizes.empty()) return 1;
  std::sort(sizes.begin(), sizes.end());
  const double limit = sizes[static_cast<std::size_t>(0.98 * static_cast<double>(sizes.size() - 1))];
  return limit > 0 ? limit : 1;
}

void draw_colour_bar(Drawing& drawing, Place at, double limit) {
  constexpr double kStep = 13;
  for (int i = -kShades; i <= kShades; ++i) {
    drawing.open(shade(std::abs(i), i > 0));
    drawing.rect(at.x + (i + kShades) * kStep, at.y, kStep, 10);
    drawing.close();
  }
  const double end = at.x + (2 * kShades + 1) * kStep;
  drawing.text({at.x - 5, at.y + 9}, "−" + short_number(limit), Anchor::end, Tone::quiet);
  drawing.text({end + 5, at.y + 9}, "+" + short_number(limit) + " nT", Anchor::start, Tone::quiet);
}

double rms(const std::vector<double>& values) {
  double squares = 0, n = 0;
  for (const double x : values)
    if (std::isfinite(x)) squares += x * x, ++n;
  return n > 0 ? std::sqrt(squares / n) : 0;
}

}  // namespace

Figure skies_figure(const SkiesValues& v) {
  const bool pair =
      std::any_of(v.skies.begin(), v.skies.end(), [](const Sky& s) { return !s.after_nT.empty(); });
  const auto columns = static_cast<int>(std::clamp<std::size_t>(v.skies.size(), 1, 4));
  const int lines = (static_cast<int>(v.skies.size()) + columns - 1) / columns;
  const double cell = 810.0 / std::max(columns, 2), a = cell / 2 - 12, row = a + 46;
  const int rows = std::max(1, lines * (pair ? 2 : 1));
  Drawing drawing("skies", 820, row * rows + 26);
  const double limit = limit_of(v);
  std::string rest;
  for (std::size_t s = 0; s < v.skies.size(); ++s) {
    const Sky& sky = v.skies[s];
    for (int after = 0; after < (pair ? 2 : 1); ++after) {
      const int line = static_cast<int>(s) / columns + after * lines;
      const Map map{{5 + cell * (static_cast<int>(s) % columns + 0.5), row * line + 26 + a / 2}, a};
      const auto& values = after == 0 ? sky.residual_nT : sky.after_nT;
      draw_sky(drawing, map, sky, values, limit);
      drawing.text({map.middle.x - a, row * line + 14}, sky.sensor, Anchor::start, Tone::ink, kFontSize,
                   true);
      if (pair)
        drawing.text({map.middle.x + a, row * line + 14}, after == 0 ? "without effects" : "with the effects",
                     Anchor::end, Tone::quiet, 10);
    }
    rest += fmt::format("{}{} {} nT{}{}", rest.empty() ? "" : ", ", sky.sensor,
                        short_number(rms(sky.residual_nT)),
                        pair ? " → " + short_number(rms(sky.after_nT)) + " nT" : "",
                        sky.p_text.empty() ? "" : " (" + sky.p_text + ")");
  }
  draw_colour_bar(drawing, {300, row * rows + 8}, limit);
  Figure out{
      .name = "skies",
      .title = "The residual over the direction of the field in each sensor",
      .svg = {},
      .caption = v.what +
                 " Mollweide's equal-area projection, +x of the sensor in the middle, +z at the top; "
                 "blue is below zero, orange above, one scale for all maps.",
      .good =
          "no patch of one colour. A pattern in one sensor is that sensor; in all of them it is the site or "
          "the "
          "table. Here the root mean squares are " +
          rest + ".",
      .data = {.head = {"sensor", "pose", "longitude, deg", "latitude, deg", "residual, nT"}, .rows = {}},
      .wide = true,
      .stands_out = v.stands_out};
  if (pair) out.data.head.push_back("with the effects, nT");
  for (const Sky& sky : v.skies) {
    for (std::size_t i = 0; i < sky.directions.size() && sky.directions.size() <= kMostSkyMarks; ++i) {
      const Eigen::Vector3d d = sky.directions[i].normalized();
      out.data.rows.push_back({sky.sensor, i < sky.poses.size() ? fmt::format("{}", sky.poses[i]) : "",
                               fmt::format("{:.1f}", std::atan2(d.y(), d.x()) / kDeg),
                               fmt::format("{:.1f}", std::asin(std::clamp(d.z(), -1.0, 1.0)) / kDeg),
                               short_number(sky.residual_nT[i])});
      if (pair) out.data.rows.back().push_back(i < sky.after_nT.size() ? short_number(sky.after_nT[i]) : "");
    }
  }
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

std::string good_coverage(double hole_deg, std::size_t measured, double good_deg) {
  return fmt::format(
      "no direction farther than {:.0f}° from a pose. Here the largest hole has a radius of {:.0f}°, with {} "
      "directions.",
      good_deg, hole_deg, measured);
}

Figure coverage_figure(const CoverageValues& v) {
  Drawing drawing("coverage", 410, 246);
  const Map map{{205, 128}, 192};
  draw_graticule(drawing, map, true);
  const LargestHole hole = largest_hole(v.measured);
  std::vector<Place> part;
  double before = 0;
  drawing.open({.stroke = Tone::vermilion, .width = 1.6, .dash = "5 3"});
  const auto circle =
      v.measured.empty() ? std::vector<Eigen::Vector3d>{} : circle_around(hole.centre, hole.radius_rad, 120);
  for (const Eigen::Vector3d& d : circle) {
    const SkyPoint p = sky_point(d);
    // Over the edge of the map the line begins anew on its other side.
    if (!part.empty() && std::abs(p.x - before) > kSkyHalfWidth / 2) drawing.polyline(part), part.clear();
    part.push_back(map.at(p));
    before = p.x;
  }
  drawing.polyline(part);
  drawing.close();
  drawing.open({.stroke = Tone::quiet, .width = 1.1});
  for (const Eigen::Vector3d& d : v.planned) drawing.mark(Shape::circle, map.at(sky_point(d)), 3);
  drawing.close();
  if (v.measured.size() > kMostSkyMarks) {
    std::vector<double> counts(v.measured.size(), 1);
    const std::vector<double> filled = cell_means(v.measured, counts);
    const std::vector<SkyCell> cells = sky_cells(kCellRows, kCellColumns);
    drawing.open({.fill = Tone::blue, .opacity = 0.5});
    for (std::size_t i = 0; i < filled.size(); ++i)
      if (std::isfinite(filled[i])) drawing.polygon(outline(map, cells[i]));
    drawing.close();
  } else {
    drawing.open({.fill = Tone::blue, .opacity = 0.85}, "marks");
    for (const Eigen::Vector3d& d : v.measured) drawing.mark(Shape::circle, map.at(sky_point(d)), 2.6);
    drawing.close();
  }
  const double radius_deg = v.measured.empty() ? 180 : hole.radius_rad / kDeg;
  Figure out{.name = "coverage",
             .title = v.ahead ? "Directions of the field that the poses will reach"
                              : "Directions of the field that were measured",
             .svg = {},
             .caption = fmt::format(
                 "Direction of the field in the frame of the platform, Mollweide's equal-area projection. "
                 "{}The dashed circle is the largest hole.",
                 v.planned.empty() ? "" : "Filled: measured; open: planned. "),
             .good = good_coverage(radius_deg, v.measured.size(), v.good_deg),
             .data = {.head = {"", "longitude, deg", "latitude, deg"}, .rows = {}}};
  const auto add = [&](const std::string& name, const Eigen::Vector3d& d) {
    out.data.rows.push_back(
        {name, fmt::format("{:.1f}", std::atan2(d.y(), d.x()) / kDeg),
         fmt::format("{:.1f}", std::asin(std::clamp(d.normalized().z(), -1.0, 1.0)) / kDeg)});
  };
  add(fmt::format("middle of the largest hole, radius {:.1f} deg", radius_deg), hole.centre);
  for (const Eigen::Vector3d& d : v.measured)
    if (v.measured.size() <= kMostSkyMarks) add(v.ahead ? "planned" : "measured", d);
  for (const Eigen::Vector3d& d : v.planned) add("planned", d);
  out.stands_out = radius_deg > v.good_deg;
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
