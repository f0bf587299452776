// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/lane_request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "proto/number.h"

namespace mgtd::daemon::serve::console {
namespace {

tl::unexpected<Error> bad(std::string what) {
  return fail(ErrorCode::bad_input, std::move(what), "/lane?channel=xx&window_s=3600&columns=600");
}

/// Three decimals are enough to draw.
nlohmann::json rounded(const std::vector<double>& values) {
  auto out = nlohmann::json::array();
  for (const double v : values)
    out.push_back(std::isfinite(v) ? nlohmann::json(std::round(v * 1e3) / 1e3) : nlohmann::json());
  return out;
}

std::optional<double> in_range(std::string_view text, double least, double most) {
  const auto value = parse_number(text);
  return value && *value >= least && *value <= most ? std::optional(*value) : std::nullopt;
}

}  // namespace

Result<LaneRequest> parse_lane_request(std::string_view query) {
  constexpr double kDay_s = 86'400, kMostColumns = 2'000;
  constexpr std::size_t kLongestName = 64;
  LaneRequest out;
  while (!query.empty()) {
    const std::string_view part = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), part.size() + 1));
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) return bad("a part of the request has no '='");
    const std::string_view key = part.substr(0, equals), value = part.substr(equals + 1);
    if (key == "channel") {
      if (value.empty() || value.size() > kLongestName) return bad("channel: a name of 1 to 64 letters");
      out.channel = value;
    } else if (key == "window_s") {
      const auto window_s = in_range(value, 1, kDay_s);
      if (!window_s) return bad("window_s: 1 to 86400 seconds");
      out.window_s = *window_s;
    } else if (key == "columns") {
      const auto columns = in_range(value, 1, kMostColumns);
      if (!columns) return bad("columns: 1 to 2000");
      out.columns = static_cast<std::size_t>(*columns);
    } else {
      return bad("there are channel, window_s and columns");
    }
  }
  if (out.channel.empty()) return bad("channel is missing");
  return out;
}

Result<std::string> answer(const LaneRequest& request, const LaneHistory& history) {
  const auto lane = history.lane(request.channel, request.window_s, request.columns);
  if (!lane)
    return bad(fmt::format("there is no such channel; there are {}", fmt::join(history.channels(), ", ")));
  auto gaps = nlohmann::json::array();
  for (const LaneGap& gap : history.gaps(request.window_s))
    gaps.push_back({{"from_s", gap.from_s}, {"to_s", gap.to_s}, {"why", gap.why}});
  const nlohmann::json out{{"channel", request.channel},    {"from_s", lane->from_s},
                           {"step_s", lane->step_s},        {"mean", rounded(lane->mean)},
                           {"least", rounded(lane->least)}, {"greatest", rounded(lane->greatest)},
                           {"gaps", std::move(gaps)}};
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace mgtd::daemon::serve::console
