// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "calib/discovery/discovery_report.h"

/// These functions write what discover() found as JSON (mgt.discover/1) and as text for a person. `run` as
/// the person typed it, for the commands that the text proposes; `to_model`: those that come first, so that
/// the kept model is the one that was searched; `kept`: names under which the run keeps the formulas already.
namespace mgtd::calib::report {

struct CommandsToModel {
  std::string run{};  ///< file that keeps the model then; empty: the one that was searched
  std::vector<std::string> commands{};
};

[[nodiscard]] nlohmann::json to_json(const discovery::DiscoveryReport& report, const std::string& run,
                                     const CommandsToModel& to_model = {},
                                     const std::vector<std::string>& kept = {});
[[nodiscard]] std::string to_text(const discovery::DiscoveryReport& report, const std::string& run,
                                  const CommandsToModel& to_model = {},
                                  const std::vector<std::string>& kept = {});

}  // namespace mgtd::calib::report
