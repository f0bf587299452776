// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/joint/joint_problem.h"

namespace mgtd::calib::fit::joint {

/// is_turned() tells whether the attitude of a pose is a right angle or more from the table's angles, as one
/// gross reading can turn it.
[[nodiscard]] inline bool is_turned(const JointPose& pose, const Nuisance& x) {
  constexpr double kRightAngle = 2;  // of 2 tan(angle/2)
  return pose.has_angles && x.head<3>().norm() > kRightAngle;
}

/// Attitude and field of a pose as the table's angles and the scalar reference tell them.
[[nodiscard]] inline Nuisance at_the_table(const JointPose& pose, const JointState& state) {
  return {0, 0, 0, pose.f_weight > 0 && pose.f_nT > 0 ? pose.f_nT : state.f_nT};
}

}  // namespace mgtd::calib::fit::joint
