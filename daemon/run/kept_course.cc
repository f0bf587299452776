// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/kept_course.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "calib/fit/joint/tensor_uncertainty.h"
#include "proto/significant.h"

namespace mgtd::daemon::run {
namespace {

using nlohmann::json;

json number(double value) { return std::isfinite(value) ? json(value) : json(); }

double number_of(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

/// Not known where an earlier version did not keep it.
double number_at(const json& object, const char* key) {
  return object.contains(key) ? number_of(object.at(key)) : std::numeric_limits<double>::quiet_NaN();
}

CourseAccuracy accuracy_of(const json& a) {
  const json& sd = a.at("sd_nT_per_m");
  CourseAccuracy out{.poses = a.at("poses").get<int>()};
  out.tensor_sd_nT_per_m = {number_of(sd.at(0)), number_of(sd.at(1)), number_of(sd.at(2)),
                            number_of(sd.at(3)), number_of(sd.at(4)), number_of(sd.at(5))};
  out.fit = {.residual_nT = number_at(a, "residual_nT"),
             .offset_sd_nT = number_at(a, "offset_sd_nT"),
             .scale_sd = number_at(a, "scale_sd"),
             .angle_sd_rad = number_at(a, "angle_sd_rad")};
  for (const json& parameter : a.value("parameter_sd", json::array()))
    out.fit.parameter_sd.push_back(number_of(parameter));
  out.worst_nT_per_m = calib::fit::joint::worst_component(out.tensor_sd_nT_per_m).value;
  return out;
}

CourseDisturbance disturbance_of(const json& d) {
  CourseDisturbance out{.t = {d.at("t_ns").get<std::int64_t>()},
                        .pose = d.at("pose").get<int>(),
                        .change_nT = number_of(d.at("change_nT")),
                        .limit_nT = number_of(d.at("limit_nT")),
                        .seen_by = d.at("seen_by").get<std::string>(),
                        .lasted_s = {},
                        .then = d.at("then").get<std::string>()};
  if (!d.at("lasted_s").is_null()) out.lasted_s = d.at("lasted_s").get<double>();
  return out;
}

}  // namespace

json to_json(const KeptCourse& course) {
  json accuracy = json::array(), disturbances = json::array();
  for (const CourseAccuracy& a : course.accuracy) {
    json sd = json::array(), parameter_sd = json::array();
    for (const double component : components(a.tensor_sd_nT_per_m)) sd.push_back(number(component));
    for (const double parameter : a.fit.parameter_sd) parameter_sd.push_back(number(significant(parameter)));
    accuracy.push_back({{"poses", a.poses},
                        {"sd_nT_per_m", std::move(sd)},
                        {"residual_nT", number(a.fit.residual_nT)},
                        {"offset_sd_nT", number(a.fit.offset_sd_nT)},
                        {"scale_sd", number(a.fit.scale_sd)},
                        {"angle_sd_rad", number(a.fit.angle_sd_rad)},
                        {"parameter_sd", std::move(parameter_sd)}});
  }
  for (const CourseDisturbance& d : course.disturbances)
    disturbances.push_back({{"t_ns", d.t.ns},
                            {"pose", d.pose},
                            {"change_nT", number(d.change_nT)},
                            {"limit_nT", number(d.limit_nT)},
                            {"seen_by", d.seen_by},
                            {"lasted_s", d.lasted_s ? number(*d.lasted_s) : json()},
                            {"then", d.then}});
  return {{"accuracy", std::move(accuracy)}, {"disturbances", std::move(disturbances)}};
}

Result<KeptCourse> kept_course_from_json(std::string_view text) {
  KeptCourse out;
  if (text.empty()) return out;
  try {
    const json kept = json::parse(text);
    for (const json& a : kept.at("accuracy")) out.accuracy.push_back(accuracy_of(a));
    for (const json& d : kept.at("disturbances")) out.disturbances.push_back(disturbance_of(d));
  } catch (const json::exception& error) {
    return fail(ErrorCode::bad_input,
                std::string("what the run had gained before cannot be read: ") + error.what(),
                "it was written by another version of mgtd; the poses are there all the same");
  }
  return out;
}

}  // namespace mgtd::daemon::run
