// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "calib/criticism/search/explain_report.h"
#include "calib/discovery/discovery_report.h"
#include "calib/fit/fit_options.h"
#include "daemon/store/pose_source.h"
#include "proto/error.h"

/// The last stage of `mgt explain` and `mgt improve`: the formula of what the effects of the library leave.
namespace mgtd::daemon::cli {

/// Empty where nothing was asked: `left` is neither PARTIAL nor UNKNOWN.
using RemainingLaw = std::optional<Result<calib::discovery::DiscoveryReport>>;

/// Searches beside the model in `options`, without the checks of discover() that fit again.
[[nodiscard]] RemainingLaw remaining_law(const PoseTable& table, const calib::fit::FitOptions& options,
                                         calib::criticism::search::Finding left);

/// That of `mgt discover --quick`, null where nothing was asked; where the search was refused, an object with
/// `refused` and `remedy`. `options`: with the model that was searched; `source`: with the one that is kept.
[[nodiscard]] nlohmann::json law_json(const RemainingLaw& law, const calib::fit::FitOptions& options,
                                      const store::PoseSource& source, const std::string& run);
/// A section below the text of the verdict; empty where nothing was asked.
[[nodiscard]] std::string law_text(const RemainingLaw& law, const calib::fit::FitOptions& options,
                                   const store::PoseSource& source, const std::string& run);

}  // namespace mgtd::daemon::cli
