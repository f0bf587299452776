// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>

#include "calib/fit/joint/joint_fit.h"

/// These functions cross-validate a joint fit in one step: they tell by how much the fit misses the poses of
/// a fold when the others alone are fitted. There are ten folds, contiguous in time.
///
/// The fit without a fold is one Gauss-Newton step from the fit with it: with S and g the normal equations of
/// all and S_k, g_k the share of the fold, (S - S_k) dx = g - g_k. One pass over the poses serves all folds,
/// where fitting ten times needs some thirty.
namespace mgtd::calib::fit::joint {

/// With the normal equations of all poses, undamped: calls `use` with the poses of each fold in turn and the
/// state that the others give them: the fixed block one step on, each pose with its own best field and
/// attitude. False where a fold cannot be left out; the folds before it have been used then.
[[nodiscard]] bool for_each_fold_left_out(
    const JointFit& fit, const Reduced& equations,
    const std::function<void(const JointProblem& fold, const JointState& state)>& use);

/// Residual (PoseResiduals::unseen_nT) on poses that were left out, nT. Empty where a fold cannot be left
/// out.
[[nodiscard]] std::optional<double> left_out_nT(const JointFit& fit);

}  // namespace mgtd::calib::fit::joint
