// SPDX-License-Identifier: Apache-2.0
#include "calib/report/measured_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "calib/report/figure_words.h"
#include "calib/report/figures/sky.h"
#include "calib/report/figures/sky_figures.h"
#include "calib/report/named_columns.h"

namespace mgtd::calib::report {
namespace {

using criticism::tests::MeasuredColumns;
using nlohmann::json;

/// Lowest and highest of what is finite.
struct Extremes {
  double low{0}, high{0};
  bool any{false};
  [[nodiscard]] double span() const { return high - low; }
};

template <typename Values>
Extremes extremes_of(const Values& values) {
  Extremes out;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    out.low = out.any ? std::min(out.low, v) : v;
    out.high = out.any ? std::max(out.high, v) : v;
    out.any = true;
  }
  return out;
}

Extremes extremes_of_all(const Eigen::MatrixXd& m) {
  return extremes_of(Eigen::Map<const Eigen::VectorXd>(m.data(), m.size()));
}

std::vector<double> values_of(const std::vector<NamedColumn>& columns, const std::string& group) {
  std::vector<double> out;
  for (const NamedColumn& column : columns)
    if (column.group == group) out.insert(out.end(), column.values.begin(), column.values.end());
  return out;
}

json panel(std::string name, std::string title, std::string caption, std::string good,
           bool stands_out = false) {
  figures::Figure figure;
  figure.name = std::move(name);
  figure.title = std::move(title);
  figure.caption = std::move(caption);
  figure.good = std::move(good);
  figure.stands_out = stands_out;
  return words_json(figure);
}

/// The sensor that was looked at from the fewest sides, and how far the farthest direction is from a pose.
std::pair<Eigen::Index, double> largest_hole_deg(const MeasuredColumns& p) {
  std::pair<Eigen::Index, double> out{0, 0};
  for (Eigen::Index s = 0; s < p.length_nT.rows(); ++s) {
    std::vector<Eigen::Vector3d> directions;
    for (Eigen::Index k = 0; k < p.direction_S.cols(); ++k) {
      const Eigen::Vector3d d = p.direction_S.block<3, 1>(3 * s, k);
      if (d.allFinite()) directions.push_back(d);
    }
    const double radius_deg =
        directions.empty() ? 180 : figures::largest_hole(directions).radius_rad * 180 / std::numbers::pi;
    if (radius_deg > out.second) out = {s, radius_deg};
  }
  return out;
}

json raw_panel(const MeasuredColumns& p) {
  const Extremes raw = extremes_of_all(p.raw_nT);
  return panel(
      "measured-raw", "Length of the raw readings against time",
      p.field_known ? "Length of the three readings of each sensor less the field of the pose, before "
                      "any calibration."
                    : "Length of the three readings of each sensor less its median, before any "
                      "calibration: no field was measured or given.",
      fmt::format("a band that does not drift: offsets, scales and angles of the axes make its width, "
                  "and a pose outside it is a wrong reading. Here it reaches from {:.4g} to {:.4g} nT.",
                  raw.low, raw.high));
}

json sky_panel(const MeasuredColumns& p) {
  const auto [sensor, hole_deg] = largest_hole_deg(p);
  return panel("measured-skies", "The same over the direction of the readings",
               "Each sensor saw the field in these directions.",
               fmt::format("points on all sides, and colours that change slowly: no direction farther than "
                           "{:.0f}° from a pose. Here the largest hole, in s{}, has a radius of {:.0f}°.",
                           figures::kGoodHole_deg, sensor + 1, hole_deg),
               hole_deg > figures::kGoodHole_deg);
}

/// Lengths less the mean over the sensors.
Eigen::MatrixXd against_each_other(const MeasuredColumns& p) {
  return p.length_nT.rowwise() - p.length_nT.colwise().mean();
}

json angles_panel(const std::vector<NamedColumn>& columns) {
  std::vector<std::string> spans;
  bool any = false;
  int axes = 0;
  for (const char* const name : {"azimuth_deg", "pitch_deg", "roll_deg"}) {
    const Extremes e = extremes_of(values_of(columns, name));
    any = any || e.any;
    axes += e.span() > 1 ? 1 : 0;
    spans.push_back(e.any ? fmt::format("{:.4g}°", e.span()) : "an unknown angle");
  }
  if (!any) return {};
  return panel(
      "measured-angles", "Table angles against time", "Azimuth, pitch and roll of the table.",
      fmt::format("the table turns about two axes at least. Here azimuth spans {}, pitch {}, roll {}.",
                  spans[0], spans[1], spans[2]),
      axes < 2);
}

json spread_panel(const MeasuredColumns& p) {
  const Extremes e = extremes_of_all(p.spread_nT);
  if (!e.any) return {};
  return panel(
      "measured-spread", "Spread within the dwells against time",
      "Standard deviation of one sample, rms over the axes of a sensor.",
      fmt::format("level and alike in all sensors: a dwell above the others was disturbed. Here from "
                  "{:.3g} to {:.3g} nT.",
                  e.low, e.high));
}

json panels_of(const MeasuredColumns& p, const std::vector<NamedColumn>& columns) {
  json out = json::array();
  const auto add = [&](json words) {
    if (!words.is_null()) out.push_back(std::move(words));
  };
  const Extremes readings = extremes_of_all(p.reading_nT), time = extremes_of(p.t_h);
  add(raw_panel(p));
  add(sky_panel(p));
  if (p.length_nT.rows() > 1) {
    const Extremes e = extremes_of_all(against_each_other(p));
    add(panel("measured-difference", "The sensors against each other",
              "Length of the readings of each sensor less the mean over the sensors: blind to the field.",
              fmt::format("bands that stay where they are: a step in one of them is that sensor. Here they "
                          "reach from {:.4g} to {:.4g} nT.",
                          e.low, e.high)));
  }
  const std::string reading_good = fmt::format(
      "the same attitude gives the same reading. Here the readings of all axes reach from {:.5g} to {:.5g} "
      "nT.",
      readings.low, readings.high);
  add(panel("measured-time", "Readings against time", "The raw readings of one axis.", reading_good));
  if (extremes_of(values_of(columns, "azimuth_deg")).any)
    add(panel("measured-azimuth", "Readings against azimuth", "The raw readings of one axis.",
              "a wave for each tilt of the table: a point beside all of them is a wrong reading or a wrong "
              "angle. " +
                  reading_good.substr(reading_good.find("Here "))));
  if (const Extremes f = extremes_of(p.f_nT); f.span() > 0)
    add(panel("measured-field", "Field against time", "Total field of each pose.",
              fmt::format("level, or slow as the field of the Earth is. Here it spans {:.3g} nT in {:.2f} h.",
                          f.span(), time.span())));
  if (const Extremes T = extremes_of(values_of(columns, "T_degC")); T.any)
    add(panel("measured-temperature", "Temperatures against time", "Temperature of each sensor.",
              fmt::format("level, or slow. Here they span {:.3g} °C in {:.2f} h.", T.span(), time.span())));
  add(angles_panel(columns));
  add(spread_panel(p));
  return out;
}

}  // namespace

json to_json(const MeasuredColumns& p) {
  json number = json::array(), set = json::array();
  for (const Pose* pose : p.pose) {
    number.push_back(pose->number);
    set.push_back(pose->set);
  }
  const Eigen::Index sensors = p.length_nT.rows();
  const std::vector<std::string> channels = channel_names(3 * sensors), names = sensor_names(sensors);
  std::vector<NamedColumn> columns = circumstance_columns(p.pose, p.t_h, p.columns, sensors);
  columns.push_back({"f_nT", "", p.f_nT});
  add_rows("reading_nT", channels, p.reading_nT, columns);
  add_rows("spread_nT", names, p.spread_nT, columns);
  add_rows("raw_nT", names, p.raw_nT, columns);
  if (sensors > 1) add_rows("difference_nT", names, against_each_other(p), columns);
  add_rows("direction_S", channels, p.direction_S, columns);
  json poses{{"pose", std::move(number)}, {"set", std::move(set)}, {"columns", json::object()}};
  put_columns(columns, poses);
  return {{"poses", std::move(poses)},
          {"panels", p.pose.empty() ? json::array() : panels_of(p, columns)},
          {"less", p.field_known ? "F" : "its median"}};
}

}  // namespace mgtd::calib::report
