// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/meant_calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "proto/nearest_word.h"

namespace mgtd::daemon::cli {
namespace {

Result<std::string> newest_proposal(const nlohmann::json& calibrations) {
  std::string found, since;
  for (const auto& c : calibrations) {
    if (c.at("state") != "proposed" || c.at("since").get<std::string>() < since) continue;
    since = c.at("since");
    found = c.at("id");
  }
  if (found.empty())
    return fail(ErrorCode::state, "no calibration is proposed", "mgt run start proposes one");
  return found;
}

}  // namespace

Result<std::string> meant_calibration(const std::string& word, const nlohmann::json& calibrations) {
  if (word == "latest") return newest_proposal(calibrations);
  std::vector<std::string> all, beginning;
  for (const auto& c : calibrations) {
    all.push_back(c.at("id"));
    if (all.back() == word) return word;
    if (!word.empty() && all.back().starts_with(word)) beginning.push_back(all.back());
  }
  if (beginning.size() == 1) return beginning.front();
  if (beginning.size() > 1)
    return fail(ErrorCode::usage,
                fmt::format("'{}' is the beginning of {} calibrations: {}", word, beginning.size(),
                            fmt::join(beginning, ", ")),
                "give more of the id");
  const auto near = nearest_word(word, all);
  return fail(ErrorCode::usage,
              fmt::format("no calibration is called '{}'{}", word,
                          near ? fmt::format(", did you mean '{}'?", *near) : ""),
              "mgt calibrations list shows them");
}

}  // namespace mgtd::daemon::cli
