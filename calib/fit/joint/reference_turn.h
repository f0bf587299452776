// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calib/fit/joint/joint_problem.h"
#include "proto/error.h"

/// R_SR is the turn of a vector reference that stands still beside the table:
///
///     b_k = F_k R_k R_SR r_k/|r_k|        R_k site frame to platform frame, by the angles of the table
///
/// A field that keeps its direction n tells two of its three angles. The third, about n, then moves nothing
/// and is free; where the field wanders by an angle theta it is known to (what an attitude is known
/// to)/theta/sqrt(poses). The noise of the reference looks like wandering and tells nothing.
namespace mgtd::calib::fit::joint {

/// Standard deviation within which each step of the turn about the field is held: kFreeTurn_rad keeps the
/// equations solvable where little tells the turn, kHeldTurn_rad keeps it from following noise where the
/// field kept its direction. A step is held, not the value: nothing is pulled anywhere.
inline constexpr double kFreeTurn_rad = 1, kHeldTurn_rad = 1e-7;

/// Mean direction that the reference shows, in its own axes.
[[nodiscard]] Eigen::Vector3d mean_reference(const JointProblem& problem);

/// The directions that the reference shows spread no more than its noise makes them.
[[nodiscard]] bool keeps_direction(const JointProblem& problem);

/// The smallest turn that brings one direction to another.
[[nodiscard]] Eigen::Matrix3d turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Where the sensors and the reference stand: u_k, the field in the frame of the sensors, is Q' T_k R_SR r_k.
struct ReferencePlacement {
  Eigen::Matrix3d Q{Eigen::Matrix3d::Identity()};     ///< sensors to platform
  Eigen::Matrix3d R_SR{Eigen::Matrix3d::Identity()};  ///< reference to site
  double misfit_rad{0};                               ///< rms of the angle between both sides
};

/// Of a problem with site_reference(); `u`: the field of each of its poses in the frame of the sensors, of
/// any length. Maximises tr(Q' sum T_k R_SR r_k u_k'), linear in Q and in R_SR: R_SR is searched on a grid,
/// then both alternate (Procrustes). What the data leave open of R_SR stays near where the search began.
[[nodiscard]] ReferencePlacement place_beside(const JointProblem& problem,
                                              const std::vector<Eigen::Vector3d>& u);

/// Refuses a vector that turns with the table: it is not that of a reference beside it.
[[nodiscard]] Result<void> check_reference_stands(const JointProblem& problem,
                                                  const std::vector<Eigen::Vector3d>& u,
                                                  const ReferencePlacement& placement);

/// Standard deviation of the turn about the field by the information S of the fixed block, priors in it;
/// empty where the field kept its direction, or the turn is known to no better than 0.2 rad.
[[nodiscard]] std::optional<double> reference_turn_sd_rad(const JointProblem& problem,
                                                          const Eigen::MatrixXd& S);

}  // namespace mgtd::calib::fit::joint
