// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "calib/report/figures/figure.h"
#include "calib/report/panel_figures.h"

/// The words of a figure without its picture, for a page that draws the picture from the numbers itself: so
/// every sentence about statistics is written here, once.
namespace mgtd::calib::report {

/// {"name","title","caption","good","stands_out"}; `good` says what a good one looks like, with the number
/// of this run.
[[nodiscard]] nlohmann::json words_json(const figures::Figure& figure);

/// {"panels": words of the nine panels, "quantiles": {"n","quantile","residual","low","high"},
///  "autocorrelation": {"by_sensor","bound"}}
[[nodiscard]] nlohmann::json panels_json(const PanelModel& model);

}  // namespace mgtd::calib::report
