// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>

#include "calib/fit/fit_report.h"
#include "calib/fit/joint/joint_setup.h"

/// gauge_text() says in words what holds the freedoms that the poses leave open; this is the text `gauge` of
/// a calibration.
namespace mgtd::calib::fit::checks {

[[nodiscard]] std::string gauge_text(const FitReport& report);
[[nodiscard]] std::string gauge_text(const AzimuthOrigin& origin, double declination_sd_rad);
/// `table_sd_rad`: of the table angles, estimated; `rotation_sd_rad`: of the common rotation about X, Y and
/// Z.
[[nodiscard]] std::string gauge_text(const joint::Gauge& gauge, std::size_t sensors, double table_sd_rad,
                                     const std::array<double, 3>& rotation_sd_rad);

}  // namespace mgtd::calib::fit::checks
