// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/joint/pose_model.h"
#include "calib/linear/parts.h"

/// A joint fit pose by pose, the nuisances of each pose (its attitude and field) eliminated.
namespace mgtd::calib::fit::joint {

/// What remains of a change of the readings of one pose, each by its standard deviation, once the nuisances
/// have followed it. With N the rows of the readings by the nuisances, H = N'N and their prior, F the rows by
/// the fixed block and U = F'N:
struct FollowedPose {
  sensor::ChannelCovariance readings;  ///< I - N H^-1 N', a projection
  Eigen::MatrixXd by_fixed;            ///< F' - U H^-1 N': to the normal equations, fixed x channels
  Channels residual;                   ///< of the readings, over their standard deviations
};

[[nodiscard]] FollowedPose followed(const JointProblem& problem, const JointPose& pose, const PoseBlocks& b);

/// The sum over all poses: `add(pose, followed, sum)` adds what one pose contributes to a sum that began as
/// `nothing`.
template <class Sum>
Sum sum_over_followed(const JointProblem& problem, const JointState& state, const Sum& nothing,
                      const auto& add) {
  const PoseModel model(problem, state);
  std::vector<Sum> parts(std::max<std::size_t>(1, linear::parts_of_poses(problem.poses.size())), nothing);
  linear::for_each_poses(problem.poses.size(), [&](std::size_t part, std::size_t from, std::size_t to) {
    PoseBlocks b;
    for (std::size_t k = from; k < to; ++k) {
      assemble(problem, model, state, k, Blocks::border, b);
      add(problem.poses[k], followed(problem, problem.poses[k], b), parts[part]);
    }
  });
  for (std::size_t part = 1; part < parts.size(); ++part) parts.front() += parts[part];
  return std::move(parts.front());
}

}  // namespace mgtd::calib::fit::joint
