// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/followed_pose.h"

#include <Eigen/Cholesky>

namespace mgtd::calib::fit::joint {
namespace {

/// Rows of the readings by the fixed block, weighted, of one pose.
Eigen::MatrixXd fixed_rows(const JointProblem& problem, const JointPose& pose, const PoseBlocks& b) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(problem.channels(), problem.fixed());
  for (int i = 0; i < problem.sensors(); ++i)
    out.block<3, sensor::kSensorParameters>(3 * i, sensor::kSensorParameters * i) =
        b.linear.d_sensor.middleRows<3>(3 * i);
  out.rightCols(b.linear.d_global.cols()) = b.linear.d_global;
  return pose.weight.asDiagonal() * out;
}

}  // namespace

FollowedPose followed(const JointProblem& problem, const JointPose& pose, const PoseBlocks& b) {
  const Eigen::Index channels = problem.channels();
  const Eigen::LLT<Eigen::Matrix4d> H(b.H);
  const sensor::ChannelColumns<kNuisances> solved = H.solve(b.N.transpose());
  return {.readings = sensor::ChannelCovariance::Identity(channels, channels) - b.N * solved,
          .by_fixed = fixed_rows(problem, pose, b).transpose() - b.U * solved,
          .residual = b.residual - solved.transpose() * b.g};
}

}  // namespace mgtd::calib::fit::joint
