// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/joint/pose_model.h"
#include "calib/linear/parts.h"

/// followed() eliminates the nuisances of one pose of a joint fit (its attitude and field);
/// sum_over_followed() adds up what all poses contribute.
namespace mgtd::calib::fit::joint {

/// One pose whose nuisances follow every change of its readings. Each row is divided by the standard
/// deviation of its reading: N are the rows by the nuisances, F those by the fixed block, r the residual; U =
/// F'N, g = N'r with the prior, H = N'N with the prior.
struct FollowedPose {
  sensor::ChannelCovariance readings;  ///< I - N H^-1 N': what a change of the readings leaves of itself
  Eigen::MatrixXd by_fixed;            ///< F' - U H^-1 N': what it adds to the normal equations of the fit
  Channels residual;                   ///< r - N H^-1 g
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
