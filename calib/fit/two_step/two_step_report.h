// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_report.h"

namespace mgtd::calib::fit::two_step {

/// two_step_report() fits a pose table by the simplified or the two-step method. The calibration has no gauge
/// text, no checks and no seal yet.
[[nodiscard]] Result<FitReport> two_step_report(const PoseTable& table, const FitOptions& options);

}  // namespace mgtd::calib::fit::two_step
