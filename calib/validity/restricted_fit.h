// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/fit/joint/joint_problem.h"

/// restricted_fit() is the best state in which only some parameters move; the field and the attitude of each
/// pose follow. Gauss-Newton steps, each halved until the cost falls: the place of a dipole whose moment is
/// near zero would run away otherwise. A direction that the poses do not see stays where it is.
namespace mgtd::calib::validity {

/// `slots` number the parameters that move (FixedSlots).
[[nodiscard]] fit::joint::JointState restricted_fit(const fit::joint::JointProblem& problem,
                                                    const std::vector<Eigen::Index>& slots,
                                                    fit::joint::JointState state);

}  // namespace mgtd::calib::validity
