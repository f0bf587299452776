// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/followed_pose.h"

#include "calib/linear/cholesky4.h"

namespace mgtd::calib::fit::joint {

FollowedPose followed(const JointProblem& problem, const JointPose& pose, const PoseBlocks& b) {
  const Eigen::Index channels = problem.channels(), globals = b.linear.d_global.cols();
  const auto solved = linear::Cholesky4(b.H).solve(sensor::ChannelColumns<kNuisances>(b.N.transpose()));
  FollowedPose out{.readings = sensor::ChannelCovariance::Identity(channels, channels),
                   .by_fixed = Eigen::MatrixXd(problem.fixed(), channels),
                   .residual = b.residual - solved.transpose() * b.g};
  // lazyProduct: these are too small for blocking to pay.
  out.readings -= b.N.lazyProduct(solved);
  out.by_fixed = -b.U.lazyProduct(solved);
  for (int i = 0; i < problem.sensors(); ++i)
    out.by_fixed.block<sensor::kSensorParameters, 3>(sensor::kSensorParameters * i, 3 * i) +=
        b.by_sensor[static_cast<std::size_t>(i)];
  out.by_fixed.bottomRows(globals) += b.linear.d_global.transpose() * pose.weight.asDiagonal();
  return out;
}

}  // namespace mgtd::calib::fit::joint
