// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/fit/joint/joint_fit.h"

namespace mgtd::calib::fit::joint {

/// Residual (PoseResiduals::unseen_nT) on poses that were left out, nT: ten folds contiguous in time, the
/// fixed block fitted to the others, each left-out pose with its own best field and attitude.
///
/// The fit without a fold is one Gauss-Newton step from the fit with it: with S and g the normal equations of
/// all and S_k, g_k the share of the fold, (S - S_k) dx = g - g_k. One pass over the poses serves all folds,
/// where held_out_errors() fits ten times. Empty where a fold cannot be left out.
[[nodiscard]] std::optional<double> left_out_nT(const JointFit& fit);

}  // namespace mgtd::calib::fit::joint
