// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/search/explain.h"
#include "calib/report/figures/figure.h"

/// These functions draw the figures of a search for what a model lacks.
namespace mgtd::daemon::cli {

/// What could be missing, and the evidence for the first of it.
[[nodiscard]] std::vector<calib::report::figures::Figure> candidate_figures(
    const PoseTable& table, const calib::criticism::search::ExplainOptions& options,
    const calib::criticism::search::ExplainReport& explained);

/// What this run cannot see and, where the report holds it, what it cannot tell apart.
[[nodiscard]] std::vector<calib::report::figures::Figure> limit_figures(
    const calib::criticism::search::ExplainReport& explained);

}  // namespace mgtd::daemon::cli
