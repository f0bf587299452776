// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/search/next_pair.h"
#include "calib/design/hypothesis.h"
#include "calib/fit/fit_options.h"

namespace mgtd::calib::criticism::search {

/// next_among() finds which further measurement would tell several formulas or effects apart
/// (design/hypothesis_menu.h). `options`: the model, without any of them. Where the run tells all of them
/// apart already there are no steps and NextReport::told_apart. Refuses what hypothesis_menu() refuses.
[[nodiscard]] Result<NextReport> next_among(const PoseTable& table, const fit::FitOptions& options,
                                            const std::vector<design::Hypothesis>& hypotheses);

}  // namespace mgtd::calib::criticism::search
