// SPDX-License-Identifier: Apache-2.0
#include "proto/run_log.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace mgtd {

RunLog latest_of(std::string run_id, std::vector<RunLogEntry> all) {
  RunLog out{.run_id = std::move(run_id)};
  if (all.size() > RunLog::kMostEntries) {
    out.left_out = all.size() - RunLog::kMostEntries;
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(out.left_out));
  }
  out.entries = std::move(all);
  return out;
}

nlohmann::ordered_json to_json(const RunLog& log) {
  auto events = nlohmann::ordered_json::array();
  for (const RunLogEntry& entry : log.entries)
    events.push_back({{"t", format_utc(entry.t)}, {"what", entry.what}});
  return {{"run_id", log.run_id}, {"left_out", log.left_out}, {"events", std::move(events)}};
}

}  // namespace mgtd
