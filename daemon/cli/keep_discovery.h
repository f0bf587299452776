// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "calib/discovery/discovery_report.h"
#include "daemon/cli/kept_run.h"

/// `mgt discover --keep` makes what it found part of the run file.
namespace mgtd::daemon::cli {

/// Keeps the search for the report, and of a LAW or LAW-SET the leading formula of each law with how probable
/// it is and what else it could be. A formula whose name another one has gets a name of its own. Returns the
/// names of the formulas. `source`: the poses that were searched, and the formulas that `file` keeps;
/// `options`: with the model that was searched beside; `found_json`: mgt.discover/1.
[[nodiscard]] Result<std::vector<std::string>> keep_discovery(store::RunFile& file, store::PoseSource& source,
                                                              const calib::fit::FitOptions& options,
                                                              const calib::discovery::DiscoveryReport& found,
                                                              nlohmann::json found_json);

}  // namespace mgtd::daemon::cli
