// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/search/model_stage.h"
#include "calib/report/figures/figure.h"

/// price_figures() draws what the effects of a model cost and what leaving them out would do.
namespace mgtd::daemon::cli {

/// `stage`: the fit with the effects. Empty where the fit without them refuses; without impacts where none
/// can be computed.
[[nodiscard]] std::vector<calib::report::figures::Figure> price_figures(
    const PoseTable& table, const calib::criticism::search::ModelStage& stage);

}  // namespace mgtd::daemon::cli
