// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/joint/joint_problem.h"
#include "proto/error.h"

/// joint_start() finds a start for the joint fit from the poses alone, for any mounting, handedness and
/// offset:
///   1. each sensor by itself: sensor_start.h;
///   2. sensors to each other: Procrustes over all poses, reflections allowed;
///   3. sensors to the table: the rotation Q and the site direction n that best explain Q u_k = T_k n,
///      n searched over the whole sphere. (Q, n) and (-Q, -n) fit equally: the majority of the sensors is
///      taken as right-handed. With a reference beside the table Q u_k = T_k R_SR r_k (reference_turn.h).
/// Without table angles, or with angles about one axis only, the freedom that is left is spent on turning
/// sensor 1 upright.
namespace mgtd::calib::fit::joint {

/// How much of the common rotation the table angles decide.
enum class AngleCoverage { none, one_axis, full };
[[nodiscard]] AngleCoverage angle_coverage(const JointProblem& problem);

/// Fills sensors, direction, F or R_SR, and nuisances; the coefficients of effects start at zero. `f_nT` is
/// the field where a pose has none.
[[nodiscard]] Result<JointState> joint_start(const JointProblem& problem, double f_nT);

/// A state around given sensors (a two-step result, an earlier calibration, another fold's fit).
[[nodiscard]] JointState joint_state(const JointProblem& problem,
                                     const PerSensor<sensor::SensorModel>& sensors,
                                     const Eigen::Vector3d& direction, double f_nT);
/// Around the sensors and the site of another state.
[[nodiscard]] JointState joint_state(const JointProblem& problem, const JointState& from);

/// The same around sensors of an earlier calibration that may stand turned on the table since: they are
/// turned together by the rotation Q that brings them to these poses' angles, or to a reference that turns
/// with them (identity without either). Refuses a reference beside the table that turns with it.
struct PlacedState {
  JointState state;
  Eigen::Matrix3d Q{Eigen::Matrix3d::Identity()};
};
[[nodiscard]] Result<PlacedState> placed_state(const JointProblem& problem,
                                               const PerSensor<sensor::SensorModel>& sensors, double f_nT);

}  // namespace mgtd::calib::fit::joint
