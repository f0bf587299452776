// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/without_poses.h"

namespace mgtd::calib::fit::joint {

JointProblem without_poses(const JointProblem& problem) {
  JointProblem out = without_poses_and_priors(problem);
  out.priors = problem.priors;
  out.known_inclination_rad = problem.known_inclination_rad;
  out.known_declination_rad = problem.known_declination_rad;
  return out;
}

JointProblem without_poses_and_priors(const JointProblem& problem) {
  return {.geometry = problem.geometry,
          .effects = problem.effects,
          .means = problem.means,
          .poses = {},
          .common_field = problem.common_field,
          .has_angles = problem.has_angles,
          .has_reference = problem.has_reference,
          .priors = {},
          .known_inclination_rad = std::nullopt,
          .known_declination_rad = std::nullopt,
          .direction_weight = problem.direction_weight,
          .stop = problem.stop,
          .on_round = problem.on_round};
}

JointState without_poses(const JointState& state) {
  return {.sensors = state.sensors,
          .direction = state.direction,
          .R_SR = state.R_SR,
          .f_nT = state.f_nT,
          .coefficients = state.coefficients,
          .nuisances = {}};
}

}  // namespace mgtd::calib::fit::joint
