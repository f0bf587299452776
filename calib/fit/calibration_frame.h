// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_report.h"
#include "calib/fit/readings.h"

/// These functions fill in the part of a calibration that does not depend on the method of the fit.
namespace mgtd::calib::fit {

[[nodiscard]] calibration::Reference reference_of(const PoseTable& table, const Readings& readings);
/// Method, geometry, reference, hashes and versions.
[[nodiscard]] calibration::Calibration calibration_frame(const PoseTable& table, const Readings& readings,
                                                         const FitOptions& options);

}  // namespace mgtd::calib::fit
