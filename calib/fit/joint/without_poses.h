// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/joint/joint_problem.h"

/// without_poses() copies a problem or a state with all but its poses, so that a subset can be fitted without
/// copying every pose.
namespace mgtd::calib::fit::joint {

[[nodiscard]] JointProblem without_poses(const JointProblem& problem);
[[nodiscard]] JointState without_poses(const JointState& state);
/// The share of poses in the normal equations is theirs alone: without what is known beforehand as well.
[[nodiscard]] JointProblem without_poses_and_priors(const JointProblem& problem);

}  // namespace mgtd::calib::fit::joint
