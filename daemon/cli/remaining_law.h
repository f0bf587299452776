// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/search/explain_report.h"
#include "calib/discovery/discovery_report.h"
#include "calib/effects/effect.h"
#include "calib/fit/fit_options.h"
#include "daemon/store/pose_source.h"
#include "proto/error.h"

/// `mgt explain` and `mgt improve` end by looking for the formula of what the effects of the library leave
/// unexplained.
namespace mgtd::daemon::cli {

struct RemainingLaw {
  Result<calib::discovery::DiscoveryReport> found;
  std::vector<calib::effects::EffectPtr> model;  ///< that was searched beside
  /// Effects that describe a part, which the formula accounts for without them; none where it stands beside
  /// them.
  std::vector<std::string> instead_of{};
};

/// Effects that describe a part may stand in for a law of no library: it is looked for in the model of
/// `options` first, and, where that leaves anything, in `described`, the model with what was named. Without
/// the checks of discover() that fit again. Empty where nothing is to be asked: `left` is neither PARTIAL nor
/// UNKNOWN.
[[nodiscard]] std::optional<RemainingLaw> remaining_law(
    const PoseTable& table, const calib::fit::FitOptions& options,
    const std::vector<calib::effects::EffectPtr>& described, calib::criticism::search::Finding left);

/// That of `mgt discover --quick` with `instead_of`, null where nothing was asked; where the search was
/// refused, an object with `refused` and `remedy`. `source`: with the model that is kept.
[[nodiscard]] nlohmann::json law_json(const std::optional<RemainingLaw>& law, const store::PoseSource& source,
                                      const std::string& run);
/// A section below the text of the verdict; empty where nothing was asked.
[[nodiscard]] std::string law_text(const std::optional<RemainingLaw>& law, const store::PoseSource& source,
                                   const std::string& run);

}  // namespace mgtd::daemon::cli
