// SPDX-License-Identifier: Apache-2.0
#include "proto/control_hold.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "proto/json_line.h"

namespace mgtd {

nlohmann::ordered_json to_json(const std::optional<ControlHolder>& holder) {
  if (!holder) return nullptr;
  return {{"pid", holder->pid},      {"uid", holder->uid},
          {"via", holder->via},      {"since", format_utc(holder->since)},
          {"taken", holder->taken},  {"why", holder->why},
          {"left_s", holder->left_s}};
}

Result<TakeRequest> parse_take_request(const nlohmann::json& args) {
  constexpr double kMaxIdle_s = 86'400;
  TakeRequest out;
  for (const auto& [key, value] : args.items()) {
    if (key == "why" && value.is_string()) {
      out.why = excerpt(value.get<std::string>());
    } else if (key == "idle_s" && value.is_number() && value.get<double>() >= 1 &&
               value.get<double>() <= kMaxIdle_s) {
      out.idle_s = value.get<double>();
    } else {
      return fail(
          ErrorCode::usage,
          fmt::format("control.take does not know {} = {}", excerpt(key), excerpt(value.dump(-1, ' ', true))),
          "its arguments are why (text) and idle_s (1 to 86400 seconds)");
    }
  }
  return out;
}

}  // namespace mgtd
