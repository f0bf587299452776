// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_report.h"
#include "calib/fit/joint/joint_fit.h"

namespace mgtd::calib::fit::joint {

/// joint_report() fits a pose table by joint maximum likelihood and reports everything that the two-step
/// method reports, the effects, the outlier nodes, and what the poses do not determine. The calibration has
/// no gauge text, no checks and no seal yet.
[[nodiscard]] Result<FitReport> joint_report(const PoseTable& table, const FitOptions& options);

[[nodiscard]] JointOptions joint_options(const FitOptions& options);
/// The same, with the numbers that its effects leave open searched on these poses: see profile_search.h. Fit,
/// compare, explain and add begin with it, so that all of them speak of one model.
[[nodiscard]] Result<JointOptions> profiled_options(const PoseTable& table, const FitOptions& options);

/// The parameters of the sensors, the effects, their covariance and the noise of a fit, into a calibration.
void fill_calibration(const JointFit& fit, calibration::Calibration& calibration);

/// Mean strength of the field over the poses.
[[nodiscard]] double mean_field(const JointFit& fit);

}  // namespace mgtd::calib::fit::joint
