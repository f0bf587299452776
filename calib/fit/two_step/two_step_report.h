// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_report.h"

namespace mgtd::calib {

/// fit() by the simplified and the two-step method.
[[nodiscard]] Result<FitReport> two_step_report(const PoseTable& table, const FitOptions& options);

}  // namespace mgtd::calib
