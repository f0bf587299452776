// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_report.h"

/// fit() makes a calibration from a pose table, and reports everything an operator must know about it.
namespace mgtd::calib::fit::method_choice {

/// Refuses (ErrorCode::refused), with what was measured and what to do: too few poses, poses about one axis
/// only; the two-step also: no field known, no or too few "standard" poses, field along platform Z or at
/// right angles to it; the joint fit also: an effect that needs what the poses do not have. Poses of the set
/// "check" are not used. A result that is not refused can still fail a check: see
/// calibration.accepted_by_checks.
[[nodiscard]] Result<FitReport> fit(const PoseTable& table, const FitOptions& options);

}  // namespace mgtd::calib::fit::method_choice
