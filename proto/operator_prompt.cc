// SPDX-License-Identifier: Apache-2.0
#include "proto/operator_prompt.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "proto/units.h"

namespace mgtd {
namespace {

constexpr double kMost_deg = 720;
using Axis = std::pair<const char*, double TableAngles::*>;
constexpr std::array kAxes{Axis{"azimuth_deg", &TableAngles::azimuth_rad},
                           Axis{"pitch_deg", &TableAngles::pitch_rad},
                           Axis{"roll_deg", &TableAngles::roll_rad}};

constexpr std::array<std::string_view, 3> kWhat{"mount", "table", "note"};  ///< beside OperatorPrompt::What

std::optional<OperatorPrompt::What> what_from(std::string_view word) {
  const auto* const found = std::find(kWhat.begin(), kWhat.end(), word);
  if (found == kWhat.end()) return std::nullopt;
  return static_cast<OperatorPrompt::What>(found - kWhat.begin());
}

std::string text_of(const nlohmann::json& object, const char* key) {
  return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : std::string();
}

double rounded_deg(double rad) { return std::round(to_deg(rad) * 1e6) / 1e6; }

}  // namespace

nlohmann::json scale_entry_json(const TableAngles& angles) {
  nlohmann::json out = nlohmann::json::object();
  for (const auto& [key, axis] : kAxes) out[key] = rounded_deg(angles.*axis);
  return out;
}

Result<ScaleEntry> parse_scale_entry(const nlohmann::json& args) {
  const auto refuse = [](std::string what) {
    return fail(ErrorCode::usage, std::move(what),
                "enter what the scales say, in degrees: azimuth_deg, pitch_deg and roll_deg");
  };
  ScaleEntry out;
  std::size_t known = kAxes.size();
  for (const auto& [key, axis] : kAxes) {
    if (!args.contains(key) || !args[key].is_number())
      return refuse(fmt::format("'{}' is not a number", key));
    const double value_deg = args[key].get<double>();
    if (!(std::abs(value_deg) <= kMost_deg))
      return refuse(fmt::format("'{}' is {} deg, outside {:.0f} deg", key, value_deg, kMost_deg));
    out.angles.*axis = to_rad(value_deg);
  }
  if (args.contains("pose")) {
    if (!args["pose"].is_number_integer()) return refuse("'pose' is not the number of a pose");
    out.pose = args["pose"].get<int>();
    ++known;
  }
  if (args.contains("what")) {
    out.what = what_from(text_of(args, "what"));
    if (!out.what) return refuse("'what' is not what a prompt asks for");
    ++known;
  }
  if (args.size() != known) return refuse("there are other keys beside the three angles, pose and what");
  return out;
}

std::string_view name(OperatorPrompt::What what) { return kWhat.at(static_cast<std::size_t>(what)); }

nlohmann::ordered_json to_json(const OperatorPrompt& p) {
  using Value = nlohmann::ordered_json;
  return {{"what", name(p.what)},
          {"pose", p.pose},
          {"mount", p.mount ? Value(*p.mount) : Value(nullptr)},
          {"target", scale_entry_json(p.target)},
          {"text", p.text},
          {"again", p.again.empty() ? Value(nullptr) : Value(p.again)}};
}

Result<OperatorPrompt> prompt_from_json(const nlohmann::json& j) {
  const auto refuse = [] {
    return fail(ErrorCode::protocol, "the answer holds no prompt that can be read",
                "use mgt and mgtd of the same version");
  };
  if (!j.is_object() || !j.contains("target") || !j["target"].is_object()) return refuse();
  auto target = parse_scale_entry(j["target"]);
  if (!target) return refuse();
  const auto what = what_from(text_of(j, "what"));
  if (!what) return refuse();
  OperatorPrompt out{
      .what = *what, .target = target->angles, .text = text_of(j, "text"), .again = text_of(j, "again")};
  if (j.contains("pose") && j["pose"].is_number_integer()) out.pose = j["pose"].get<int>();
  if (j.contains("mount") && j["mount"].is_number_integer()) out.mount = j["mount"].get<int>();
  return out;
}

}  // namespace mgtd
