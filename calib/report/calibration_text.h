// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/report/seen_width.h"

/// These functions present a calibration to a person as text. `width` is the number of columns that a table
/// may have.
namespace mgtd::calib::report {

/// Everything a calibration says of itself: what made it, of which poses, what it leaves, the parameters, the
/// coefficients of its effects, and its checks.
[[nodiscard]] std::string to_text(const calibration::Calibration& calibration, std::size_t width = kAnyWidth);

/// "joint calibration c0123456789ab of 157 poses: accepted by its checks".
[[nodiscard]] std::string calibration_heading(const calibration::Calibration& calibration);
/// The twelve parameters of each sensor with their standard deviations.
[[nodiscard]] std::string parameter_table(const calibration::Calibration& calibration, std::size_t width);
/// A row for each coefficient of each effect.
[[nodiscard]] std::string effect_table(const std::vector<calibration::CalibratedEffect>& effects);
/// A row for each check with what was measured and its limit, and the remedy of those that failed.
[[nodiscard]] std::string check_list(const std::vector<Check>& checks);
/// What the array tells; empty for the cross, which tells everything.
[[nodiscard]] std::string array_line(const sensor::Geometry& geometry);

/// As many decimals as show two digits of the standard deviation: "12.34 ± 0.56".
[[nodiscard]] std::string with_sd(double value, double sd);

}  // namespace mgtd::calib::report
