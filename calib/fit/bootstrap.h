// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "calib/fit/two_step.h"

/// Uncertainty of the two-step estimate by parametric bootstrap: the fitted rig is measured again and again,
/// with fresh noise on every pose mean, fresh errors of every table angle and of the scalar reference, and
/// fitted each time. What scatters is the uncertainty, correlations and gauge included. Replicates with a
/// seed of their own: the same data give the same answer.
namespace mgtd::calib {

struct BootstrapResult {
  ArrayCovariance covariance;
  double inclination_sd_rad{0}, declination_sd_rad{0};
  int replicates{0};  ///< that could be fitted
};

/// `pose_noise_nT`: sd of a pose mean per axis. `field_sd_nT`: of the one field given by the operator, common
/// to all poses.
[[nodiscard]] BootstrapResult bootstrap(const Readings& readings, const FitOptions& options,
                                        const TwoStep& fitted, const AxisNoise& pose_noise_nT);

}  // namespace mgtd::calib
