// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/search/explain_report.h"
#include "calib/discovery/remaining_law.h"
#include "calib/effects/effect.h"
#include "calib/fit/fit_options.h"
#include "daemon/store/pose_source.h"

/// `mgt explain` and `mgt improve` end by looking for the formula of what the effects of the library leave
/// unexplained.
namespace mgtd::daemon::cli {

/// The remaining law beside the model of `options` and what was added to it, `described`, with its progress
/// shown and without the checks of discover() that fit again. Empty where nothing is to be asked: `left` is
/// neither PARTIAL nor UNKNOWN.
[[nodiscard]] std::optional<calib::discovery::RemainingLaw> law_of_the_rest(
    const PoseTable& table, const calib::fit::FitOptions& options,
    const std::vector<calib::effects::EffectPtr>& described, calib::criticism::search::Finding left);

/// That of `mgt discover --quick` with `instead_of`, null where nothing was asked; where the search was
/// refused, an object with `refused` and `remedy`. `source`: with the model that is kept.
[[nodiscard]] nlohmann::json law_json(const std::optional<calib::discovery::RemainingLaw>& law,
                                      const store::PoseSource& source, const std::string& run);
/// A section below the text of the verdict; empty where nothing was asked.
[[nodiscard]] std::string law_text(const std::optional<calib::discovery::RemainingLaw>& law,
                                   const store::PoseSource& source, const std::string& run);

}  // namespace mgtd::daemon::cli
