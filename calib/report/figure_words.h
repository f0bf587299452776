// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "calib/report/figures/figure.h"
#include "calib/report/panel_figures.h"

/// These functions write figures as JSON: their words alone, for a page that draws the picture from the
/// numbers itself, so that every sentence about statistics is written here, once; or whole, with the picture
/// and its data.
namespace mgtd::calib::report {

/// {"name","title","caption","good","stands_out"}; `good` says what a good one looks like, with the number
/// of this run.
[[nodiscard]] nlohmann::json words_json(const figures::Figure& figure);

/// The words of several, by name.
[[nodiscard]] nlohmann::json words_by_name(const std::vector<figures::Figure>& figures);

/// By name: the words with "svg" and "points" {"head","rows","note"}, a row as an array in the order of the
/// head. A cell that is a number is one; what was not measured is "".
[[nodiscard]] nlohmann::json figures_json(const std::vector<figures::Figure>& figures);

/// {"panels": words of the nine panels, "quantiles": {"n","quantile","residual","low","high"},
///  "autocorrelation": {"by_sensor","bound"}}
[[nodiscard]] nlohmann::json panels_json(const PanelModel& model);

}  // namespace mgtd::calib::report
