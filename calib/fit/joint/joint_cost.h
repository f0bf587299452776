// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/joint/joint_solver.h"

namespace mgtd::calib::fit::joint {

/// cost_of() computes the same cost as reduce(), to the digit, without the normal equations.
[[nodiscard]] JointCost cost_of(const JointProblem& problem, const JointState& state);

}  // namespace mgtd::calib::fit::joint
