// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/run_plan_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "proto/json_text.h"
#include "proto/operator_prompt.h"
#include "proto/units.h"

namespace mgtd::daemon::plan {
namespace {

using nlohmann::json;
constexpr const char* kSchema = "mgtd.plan/1";

/// Planned angles are multiples of 0.01 deg; the conversion's last bits are not for readers.
double rounded_deg(double a_rad) { return std::round(to_deg(a_rad) * 1e6) / 1e6; }

json to_json(const PlannedPose& p) {
  return {{"number", p.number},
          {"set", p.set},
          {"azimuth_deg", rounded_deg(p.target.azimuth_rad)},
          {"pitch_deg", rounded_deg(p.target.pitch_rad)},
          {"roll_deg", rounded_deg(p.target.roll_rad)},
          {"dwell_s", p.dwell_s},
          {"sense", p.sense},
          {"mount", or_null(p.mount)},
          {"mounting", p.mount ? scale_entry_json(p.mounting) : json(nullptr)},
          {"revisit_of", or_null(p.revisit_of)},
          {"since_stop_s", or_null(p.since_stop_s)},
          {"note", p.note.empty() ? json(nullptr) : json(p.note)}};
}

TableAngles angles_from(const json& j) {
  return {to_rad(j.at("azimuth_deg").get<double>()), to_rad(j.at("pitch_deg").get<double>()),
          to_rad(j.at("roll_deg").get<double>())};
}

PlannedPose pose_from(const json& j) {
  PlannedPose p;
  p.number = j.at("number").get<int>();
  p.set = j.at("set").get<std::string>();
  p.target = angles_from(j);
  p.dwell_s = j.at("dwell_s").get<double>();
  p.sense = j.at("sense").get<int>();
  if (j.contains("mount") && !j["mount"].is_null()) {
    p.mount = j["mount"].get<int>();
    p.mounting = angles_from(j.at("mounting"));
  }
  if (j.contains("since_stop_s") && !j["since_stop_s"].is_null())
    p.since_stop_s = j["since_stop_s"].get<double>();
  if (j.contains("note") && j["note"].is_string()) p.note = j["note"].get<std::string>();
  if (!j.at("revisit_of").is_null()) p.revisit_of = j.at("revisit_of").get<int>();
  return p;
}

PlanOptions options_from(const json& j) {
  PlanOptions o;
  o.step_deg = j.at("step_deg").get<double>();
  o.random = j.at("random").get<int>();
  o.revisits = j.at("revisits").get<int>();
  o.dwell_short_s = j.at("dwell_short_s").get<double>();
  o.dwell_long_s = j.at("dwell_long_s").get<double>();
  o.seed = j.at("seed").get<std::uint64_t>();
  o.by_hand = j.value("by_hand", false);
  o.list = j.value("list", "");
  for (const json& mount : j.value("mounts", json::array())) o.mounts.push_back(angles_from(mount));
  return o;
}

/// Throws json::exception like the rest of the reading; plan_from_json turns it into an Error.
RunPlan plan_from(const json& j) {
  RunPlan plan;
  plan.options = options_from(j.at("options"));
  plan.notes = j.at("notes").get<std::vector<std::string>>();
  for (const json& pose : j.at("poses")) plan.poses.push_back(pose_from(pose));
  return plan;
}

/// A plan with one pose; what may be left out is not in it.
json example() {
  RunPlan plan;
  plan.notes = {""};
  plan.poses = {{}};
  json out = to_json(plan);
  for (const char* optional : {"by_hand", "list", "mounts"}) out["options"].erase(optional);
  for (const char* optional : {"mount", "mounting", "since_stop_s"}) out["poses"][0].erase(optional);
  return out;
}

}  // namespace

json to_json(const RunPlan& plan) {
  const PlanOptions& o = plan.options;
  json poses = json::array(), mounts = json::array();
  for (const TableAngles& mount : o.mounts) mounts.push_back(scale_entry_json(mount));
  for (const PlannedPose& pose : plan.poses) poses.push_back(to_json(pose));
  return {{"schema", kSchema},
          {"options",
           {{"step_deg", o.step_deg},
            {"random", o.random},
            {"revisits", o.revisits},
            {"dwell_short_s", o.dwell_short_s},
            {"dwell_long_s", o.dwell_long_s},
            {"seed", o.seed},
            {"by_hand", o.by_hand},
            {"list", o.list},
            {"mounts", std::move(mounts)}}},
          {"notes", plan.notes},
          {"poses", std::move(poses)}};
}

json to_json(const drivers::TableLimits& limits) {
  const auto range = [](const drivers::TableLimits::Range& r) {
    return json{rounded_deg(r.min_rad), rounded_deg(r.max_rad)};
  };
  return {{"azimuth", range(limits.azimuth)}, {"pitch", range(limits.pitch)}, {"roll", range(limits.roll)}};
}

Result<PlanOptions> plan_options_from_json(const json& options) {
  try {
    return options_from(options);
  } catch (const json::exception& error) {
    return fail(ErrorCode::protocol, fmt::format("the options of the plan cannot be read: {}", error.what()),
                "use mgt and mgtd of the same version");
  }
}

Result<drivers::TableLimits> table_limits_from_json(const json& limits) {
  try {
    const auto range = [&](const char* axis) {
      return drivers::TableLimits::Range{to_rad(limits.at(axis).at(0).get<double>()),
                                         to_rad(limits.at(axis).at(1).get<double>())};
    };
    return drivers::TableLimits{range("azimuth"), range("pitch"), range("roll")};
  } catch (const json::exception& error) {
    return fail(ErrorCode::protocol, fmt::format("the limits of the table cannot be read: {}", error.what()),
                "use mgt and mgtd of the same version");
  }
}

Result<RunPlan> plan_from_json(std::string_view text) {
  const auto refuse = [](std::string_view why) {
    return fail(ErrorCode::bad_input, fmt::format("the run's plan cannot be read: {}", why),
                "the run file is damaged or of another version: its poses can still be fitted");
  };
  const auto j = parse_json_text(text, "");
  if (!j) return refuse(j.error().message);
  if (!j->is_object() || j->value("schema", json()) != kSchema)
    return refuse(fmt::format("its schema is not {}", kSchema));
  if (const auto wrong = misfit(example(), *j)) return refuse(wrong->text(text));
  try {
    return plan_from(*j);
  } catch (const json::exception&) {
    return refuse("an entry that may be left out holds a value of another kind");
  }
}

}  // namespace mgtd::daemon::plan
