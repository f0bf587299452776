// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_report.h"
#include "calib/fit/readings.h"

/// What the reports of all methods have in common.
namespace mgtd::calib {

[[nodiscard]] Reference reference_of(const PoseTable& table, const Readings& readings);
/// Method, geometry, reference, hashes and versions.
[[nodiscard]] Calibration calibration_frame(const PoseTable& table, const Readings& readings,
                                            const FitOptions& options);
/// Acceptance by the checks, their failures as reasons, and the seal. The verdict must be there.
void conclude(FitReport& report, const std::vector<std::string>& remarks);

}  // namespace mgtd::calib
