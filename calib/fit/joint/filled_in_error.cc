// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/filled_in_error.h"

#include <algorithm>

#include "calib/fit/joint/joint_solver.h"
#include "calib/linear/cholesky.h"

namespace mgtd::calib::fit::joint {

Eigen::MatrixXd filled_in_error(const JointFit& fit, const Reduced& reduced) {
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(reduced.S.rows(), reduced.S.cols());
  const auto filled_in = [](const JointPose& pose) { return pose.filled_in; };
  if (std::none_of(fit.problem.poses.begin(), fit.problem.poses.end(), filled_in)) return nothing;
  const auto information = linear::Cholesky::of(reduced.S);
  if (!information) return nothing;
  JointProblem shifted = fit.problem;
  for (JointPose& pose : shifted.poses)
    if (pose.filled_in) pose.f_nT += fit.problem.filled_in_sd_nT;
  const Eigen::VectorXd pull = reduce(shifted, fit.state, 0).g - reduced.g;
  const Eigen::VectorXd moved = information->solve(pull);
  return moved * moved.transpose();
}

}  // namespace mgtd::calib::fit::joint
