// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/fit/joint/joint_problem.h"
#include "calib/fit/joint/reference_turn.h"
#include "proto/error.h"

/// check_angle_sense() finds a table angle that is counted in the wrong sense, by comparison with a vector
/// reference.
///
/// The directions that the sensors saw are compared with those of the reference, turned by the angles of the
/// table as they stand (rms angle m) and with one of them of the other sign (m'). Where m is above 1 degree
/// and m' below a fifth of m, that angle is counted backwards.
///
/// Which of the three it is, the directions alone do not say. A half turn A about the platform's X changes
/// the sign of azimuth and pitch, A Rz(a) Ry(p) Rx(r) A = Rz(-a) Ry(-p) Rx(r), and goes unseen into the
/// mounting of the sensors and the turn of the reference; likewise about Y (azimuth and roll) and Z (pitch
/// and roll). The angle is named with which sensor 1 stands nearest to the platform's axes; where it stands
/// within 60 degrees of them with none, none is named. A table that turns about one axis alone tells no
/// sense.
namespace mgtd::calib::fit::joint {

/// `u`: the field of each pose in the frame of sensor 1; `placement`: of them by place_beside(). Refuses
/// angles counted backwards, with both misfits and the column to be changed.
[[nodiscard]] Result<void> check_angle_sense(const JointProblem& problem,
                                             const std::vector<Eigen::Vector3d>& u,
                                             const ReferencePlacement& placement);

}  // namespace mgtd::calib::fit::joint
