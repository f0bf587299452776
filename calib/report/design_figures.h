// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/design/experiment_design.h"
#include "calib/report/figures/figure.h"

/// design_figures() draws what to expect of a run that is not yet measured: the directions of the field that
/// its poses reach, and the smallest size of each effect that they would show.
namespace mgtd::calib::report {

/// The second is left out where the power of the design was not asked for.
[[nodiscard]] std::vector<figures::Figure> design_figures(const design::DesignRequest& request,
                                                          const design::DesignReport& report);

}  // namespace mgtd::calib::report
