// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_judgement.h"

#include <nlohmann/json.hpp>

namespace mgtd::daemon::run {

nlohmann::json to_json(const std::vector<RunJudgement>& judgements) {
  nlohmann::json out = nlohmann::json::array();
  for (const RunJudgement& j : judgements)
    out.push_back({{"poses", j.poses}, {"found", j.found}, {"next", j.next}, {"minutes", j.minutes}});
  return out;
}

Result<std::vector<RunJudgement>> judgements_from_json(std::string_view text) {
  std::vector<RunJudgement> out;
  if (text.empty()) return out;
  try {
    for (const nlohmann::json& j : nlohmann::json::parse(text))
      out.push_back({.poses = j.at("poses").get<int>(),
                     .found = j.at("found").get<std::string>(),
                     .next = j.at("next").get<std::string>(),
                     .minutes = j.at("minutes").get<double>()});
  } catch (const nlohmann::json::exception& error) {
    return fail(ErrorCode::bad_input,
                std::string("the judgements of the run cannot be read: ") + error.what(),
                "they were written by another version of mgtd");
  }
  return out;
}

}  // namespace mgtd::daemon::run
