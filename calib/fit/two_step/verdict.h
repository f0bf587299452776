// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/two_step/two_step.h"

/// Is this calibration fit for use? The conjunction of named checks, each with what was measured, the limit
/// and what to do. They ask whether the estimate is sound; whether the model explains the data down to the
/// noise is said beside them (FitReport::reasons).
namespace mgtd::calib {

[[nodiscard]] std::vector<Check> verdict(const FitReport& report, const TwoStep& fitted,
                                         const FitOptions& options);

/// The checks that hold for every method: scale factors, angles, volume, residual.
[[nodiscard]] std::vector<Check> common_checks(const FitReport& report);
/// Of the poses, that may contradict the others: a robust start finds those while a third is wrong, and this
/// is what it is trusted with.
inline constexpr double kMaxBadPoses = 0.25;
/// Poses that contradict the others: of too many of them none can be trusted.
[[nodiscard]] Check bad_poses_check(const FitReport& report);

/// Sentences about what was recognised: turned and mirrored sensors, gauge, residual against the noise.
[[nodiscard]] std::vector<std::string> remarks(const FitReport& report);

/// Residual against noise, where the model does not explain the data down to it; else empty.
[[nodiscard]] std::string left_over(const FitReport& report);

/// In words, with its uncertainty.
[[nodiscard]] std::string gauge_text(const AzimuthOrigin& origin, double declination_sd_rad);

}  // namespace mgtd::calib
