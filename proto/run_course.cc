// SPDX-License-Identifier: Apache-2.0
#include "proto/run_course.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "proto/significant.h"
#include "proto/units.h"

namespace mgtd {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::array<const char*, 6> kComponents{"xx", "yy", "zz", "xy", "xz", "yz"};

constexpr std::array<std::pair<const char*, double (*)(const FitSoFar&)>, 4> kOfFit{
    {{"residual_nT", [](const FitSoFar& f) { return f.residual_nT; }},
     {"offset_sd_nT", [](const FitSoFar& f) { return f.offset_sd_nT; }},
     {"scale_sd_ppm", [](const FitSoFar& f) { return 1e6 * f.scale_sd; }},
     {"angle_sd_deg", [](const FitSoFar& f) { return to_deg(f.angle_sd_rad); }}}};

OrderedJson direction(const Eigen::Vector3d& d) {
  const auto rounded = [](double x) { return std::round(x * 1e4) / 1e4; };
  return {rounded(d.x()), rounded(d.y()), rounded(d.z())};
}

OrderedJson finite_or_null(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

OrderedJson parameters(const RunCourse& course) {
  OrderedJson name = OrderedJson::array(), unit = OrderedJson::array(), sd = OrderedJson::array();
  for (const CourseParameter& p : course.parameters) {
    name.push_back(p.name);
    unit.push_back(p.unit);
  }
  for (const CourseAccuracy& known : course.accuracy) {
    const std::vector<double>& inside = known.fit.parameter_sd;
    const bool all = !inside.empty() && inside.size() == course.parameters.size();
    OrderedJson& shown = sd.emplace_back(all ? OrderedJson::array() : OrderedJson(nullptr));
    for (std::size_t i = 0; all && i < inside.size(); ++i)
      shown.push_back(finite_or_null(significant(inside[i] * course.parameters[i].factor)));
  }
  return {{"name", std::move(name)}, {"unit", std::move(unit)}, {"sd", std::move(sd)}};
}

OrderedJson text_or_null(const std::string& text) {
  return text.empty() ? OrderedJson(nullptr) : OrderedJson(text);
}

OrderedJson coverage(const RunCourse& course) {
  OrderedJson out{{"pose", OrderedJson::array()},
                  {"state", OrderedJson::array()},
                  {"direction", OrderedJson::array()},
                  {"hole", nullptr},
                  {"good", text_or_null(course.good_coverage)}};
  for (const CoursePose& pose : course.poses) {
    out["pose"].push_back(pose.number);
    out["state"].push_back(name(pose.state));
    out["direction"].push_back(pose.direction_P ? direction(*pose.direction_P) : OrderedJson(nullptr));
  }
  if (course.hole)
    out["hole"] = {{"direction", direction(course.hole->direction_P)},
                   {"radius_deg", to_deg(course.hole->radius_rad)}};
  return out;
}

OrderedJson accuracy(const RunCourse& course) {
  OrderedJson out{{"poses", OrderedJson::array()}, {"worst_nT_per_m", OrderedJson::array()}};
  for (const char* component : kComponents) out[component] = OrderedJson::array();
  for (const CourseAccuracy& known : course.accuracy) {
    out["poses"].push_back(known.poses);
    out["worst_nT_per_m"].push_back(finite_or_null(known.worst_nT_per_m));
    const std::array<double, 6> sd = components(known.tensor_sd_nT_per_m);
    for (std::size_t i = 0; i < sd.size(); ++i) out[kComponents.at(i)].push_back(finite_or_null(sd.at(i)));
  }
  for (const auto& [key, value] : kOfFit) {
    auto& column = out[key] = OrderedJson::array();
    for (const CourseAccuracy& known : course.accuracy) column.push_back(finite_or_null(value(known.fit)));
  }
  out["parameters"] = parameters(course);
  out["wanted_nT_per_m"] =
      course.wanted_nT_per_m ? OrderedJson(*course.wanted_nT_per_m) : OrderedJson(nullptr);
  out["why"] = text_or_null(course.why_unknown);
  OrderedJson expected{{"poses", OrderedJson::array()}, {"worst_nT_per_m", OrderedJson::array()}};
  for (const CourseAccuracy& known : course.expected) {
    expected["poses"].push_back(known.poses);
    expected["worst_nT_per_m"].push_back(finite_or_null(known.worst_nT_per_m));
  }
  out["expected"] = std::move(expected);
  out["good"] = text_or_null(course.good_accuracy);
  return out;
}

OrderedJson to_json(const CourseDisturbance& d) {
  return {{"t", format_utc(d.t)},
          {"pose", d.pose},
          {"change_nT", finite_or_null(d.change_nT)},
          {"limit_nT", finite_or_null(d.limit_nT)},
          {"seen_by", d.seen_by},
          {"lasted_s", d.lasted_s ? finite_or_null(*d.lasted_s) : OrderedJson(nullptr)},
          {"then", d.then}};
}

}  // namespace

std::string_view name(CourseState state) {
  static constexpr std::array<std::string_view, 3> kNames{"planned", "next", "measured"};
  return kNames.at(static_cast<std::size_t>(state));
}

OrderedJson to_json(const RunCourse& course) {
  OrderedJson disturbances = OrderedJson::array();
  for (const CourseDisturbance& d : course.disturbances) disturbances.push_back(to_json(d));
  return {{"run_id", course.run_id},
          {"coverage", coverage(course)},
          {"accuracy", accuracy(course)},
          {"disturbances", std::move(disturbances)}};
}

void keep_last_parameters(RunCourse& course) {
  for (std::size_t i = 0; i + 1 < course.accuracy.size(); ++i) course.accuracy[i].fit.parameter_sd.clear();
}

}  // namespace mgtd
