// SPDX-License-Identifier: Apache-2.0
#include "proto/requested_pose.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "proto/json_line.h"
#include "proto/units.h"

namespace mgtd {
namespace {

using Json = nlohmann::json;

/// Multiples of a micro-degree: the conversion's last bits are not for readers.
double written_deg(double a_rad) { return std::round(to_deg(a_rad) * 1e6) / 1e6; }

bool number_within(const Json& value, double low, double high) {
  return value.is_number() && value.get<double>() >= low && value.get<double>() <= high;
}

bool whole_within(const Json& value, std::int64_t low, std::int64_t high) {
  return value.is_number_integer() &&
         number_within(value, static_cast<double>(low), static_cast<double>(high));
}

/// One line for an operator.
bool note(std::string& out, std::string text) {
  constexpr std::size_t kLongest = 200;
  if (text.size() > kLongest) return false;
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  out = std::move(text);
  return true;
}

/// False: not a key of a pose, or not a value for it.
bool take(RequestedPose& pose, const std::string& key, const Json& value) {
  constexpr std::int64_t kMost = 1'000'000'000;
  constexpr double kMostAngle_deg = 720, kLongest_s = 3600;
  const auto angle = [&](double& out_rad) {
    if (!number_within(value, -kMostAngle_deg, kMostAngle_deg)) return false;
    out_rad = to_rad(value.get<double>());
    return true;
  };
  const auto seconds = [&](std::optional<double>& out, double low) {
    if (!number_within(value, low, kLongest_s)) return false;
    out = value.get<double>();
    return true;
  };
  const auto whole = [&](int& out, std::int64_t low, std::int64_t high) {
    if (!whole_within(value, low, high)) return false;
    out = value.get<int>();
    return true;
  };
  if (key == "azimuth_deg") return angle(pose.angles.azimuth_rad);
  if (key == "pitch_deg") return angle(pose.angles.pitch_rad);
  if (key == "roll_deg") return angle(pose.angles.roll_rad);
  if (key == "pose") return whole(pose.number, -kMost, kMost);
  if (key == "line") return whole(pose.line, 0, kMost);
  if (key == "sense") return whole(pose.sense.emplace(), -1, 1);
  if (key == "dwell_s") return seconds(pose.dwell_s, 0.5);
  if (key == "since_stop_s") return seconds(pose.since_stop_s, 0);
  if (!value.is_string()) return false;
  if (key == "note") return note(pose.note, value.get<std::string>());
  if (key != "set") return false;
  pose.set = excerpt(value.get<std::string>());
  return true;
}

}  // namespace

bool operator==(const RequestedPose& a, const RequestedPose& b) { return to_json(a) == to_json(b); }

Json to_json(const RequestedPose& pose) {
  Json out{{"pose", pose.number},
           {"azimuth_deg", written_deg(pose.angles.azimuth_rad)},
           {"pitch_deg", written_deg(pose.angles.pitch_rad)},
           {"roll_deg", written_deg(pose.angles.roll_rad)},
           {"set", pose.set}};
  if (pose.sense) out["sense"] = *pose.sense;
  if (pose.dwell_s) out["dwell_s"] = *pose.dwell_s;
  if (pose.since_stop_s) out["since_stop_s"] = *pose.since_stop_s;
  if (!pose.note.empty()) out["note"] = pose.note;
  if (pose.line > 0) out["line"] = pose.line;
  return out;
}

Result<RequestedPose> requested_pose_from_json(const Json& object) {
  RequestedPose pose;
  for (const char* key : {"pose", "azimuth_deg", "pitch_deg", "roll_deg"}) {
    if (!object.is_object() || !object.contains(key))
      return fail(ErrorCode::usage, fmt::format("a pose of the list has no '{}'", key),
                  "every pose needs its number and three angles");
  }
  for (const auto& [key, value] : object.items()) {
    if (!take(pose, key, value)) {
      const std::string found = value.dump(-1, ' ', true, Json::error_handler_t::replace);
      const std::string where = object.contains("line") ? "line " + object["line"].dump() + " of " : "";
      return fail(
          ErrorCode::usage,
          fmt::format("{}the list of poses: {} = {} is not possible", where, excerpt(key), excerpt(found)),
          "angles within 720 deg, dwells of 0.5 to 3600 s, sense -1, 0 or 1, a note of at most 200 bytes");
    }
  }
  return pose;
}

}  // namespace mgtd
