// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "calib/criticism/search/choice.h"
#include "daemon/store/model_history.h"
#include "daemon/store/pose_source.h"

/// These functions find what is still in doubt about the model that a run file keeps: see
/// calib/criticism/search/choice.h.
namespace mgtd::daemon::cli {

/// How the model of RUN came to be; empty for a pose table.
[[nodiscard]] Result<std::vector<store::ModelStep>> history_of(const std::string& run,
                                                               const store::PoseSource& source);

/// What `mgt discover` said of a formula of this run, as the choice of an effect that is about to be added:
/// the formulas that its poses did not exclude, and that these poses do not either. `options`: the model,
/// with the effect in it. Empty (no spec) where the effect is no formula that was discovered.
[[nodiscard]] calib::criticism::search::Choice choice_by_discovery(const store::PoseSource& source,
                                                                   const calib::effects::Effect& effect,
                                                                   const calib::fit::FitOptions& options);

/// Of the effects in `options` that were added to the model of RUN, those about which something is open on
/// these poses.
[[nodiscard]] Result<std::vector<calib::criticism::search::Choice>> doubts_of(
    const std::string& run, const store::PoseSource& source, const calib::fit::FitOptions& options);

/// One paragraph each.
[[nodiscard]] std::string doubts_text(const std::vector<calib::criticism::search::Choice>& doubts);
[[nodiscard]] nlohmann::json doubts_json(const std::vector<calib::criticism::search::Choice>& doubts);

}  // namespace mgtd::daemon::cli
