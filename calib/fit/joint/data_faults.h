// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>

#include "calib/fit/joint/joint_problem.h"
#include "calib/sensor/channels.h"
#include "proto/error.h"

/// These functions find faults of the data that a fit could only mistake for something else, before a fit is
/// tried. All errors are `bad_input`. Medians over the poses decide, so that single gross readings do not.
namespace mgtd::calib::fit::joint {

/// Readings and total field in units a thousand (uT, pT) or a million (mT) times apart. `f_nT`: the field
/// where the poses have none of their own. Where no field is known at all, it is found from the readings and
/// nothing can be compared; readings of some tens are then taken for uT, since no site has a field of so few
/// nT.
[[nodiscard]] Result<void> check_units(const JointProblem& problem, double f_nT);

/// A sensor whose readings are those of another one, digit for digit, in nearly every pose.
[[nodiscard]] Result<void> check_copies(const JointProblem& problem);

/// Sensors that did not turn together: no fixed turn brings the directions in which they saw the field
/// together, pose by pose. `b_nT`: of each sensor, corrected for itself, in its own frame; `to_first` turns
/// them into that of sensor 1.
[[nodiscard]] Result<void> check_turned_together(const PerSensor<Eigen::Matrix3Xd>& b_nT,
                                                 const PerSensor<Eigen::Matrix3d>& to_first);

}  // namespace mgtd::calib::fit::joint
