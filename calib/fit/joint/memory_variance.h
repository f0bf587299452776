// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/joint/joint_problem.h"

/// An effect with a memory adds to the noise of a reading, because the way of the table before the pose is
/// known only as well as the table's angles are (Effect::sd_nT_per_rad):
///
///     var(y) = var(noise) + (sd_nT_per_rad table_sd_rad)²
///
/// Errors of the same way in several axes are taken as independent.
namespace mgtd::calib::fit::joint {

/// Sets JointPose::memory_nT2 from the coefficients of `state`; returns whether a weight has to move for it.
bool set_memory_variance(JointProblem& problem, const JointState& state, double table_sd_rad);

}  // namespace mgtd::calib::fit::joint
