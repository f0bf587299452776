// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "calib/fit/joint/joint_setup.h"
#include "calib/fit/readings.h"

namespace mgtd::calib::fit::joint {
namespace {
/// Below this no fluxgate and no digitiser reads, and weights stay finite on noise-free data.
constexpr double kNoiseFloor_nT = 1e-4;

void set_weight(double& weight, double sd_nT) {
  if (weight > 0) weight = 1 / std::max(sd_nT, kNoiseFloor_nT);
}

void add(const Channels& nT2, JointPose& pose) {
  for (Eigen::Index c = 0; c < nT2.size(); ++c)
    if (nT2[c] > 0) set_weight(pose.weight[c], std::sqrt(nT2[c] + 1 / std::pow(pose.weight[c], 2)));
}

}  // namespace

std::optional<calibration::AxisNoise> sample_noise(const PoseTable& table) {
  for (const Pose& pose : table.poses) {
    if (!pose.n && !pose.n_eff) return std::nullopt;
  }
  const calibration::AxisNoise pooled = pooled_sample_noise(table);
  if (!(pooled.minCoeff() > 0)) return std::nullopt;
  return pooled;
}

void weight_by_samples(JointProblem& problem, const calibration::AxisNoise& sample) {
  for (JointPose& pose : problem.poses) {
    const double n = pose.pose->n_eff ? *pose.pose->n_eff : pose.pose->n.value_or(1);
    for (int c = 0; c < problem.channels(); ++c)
      set_weight(pose.weight[c], sample(c / 3, c % 3) / std::sqrt(n));
  }
}

void weight_by_pose(JointProblem& problem, const calibration::AxisNoise& pose_mean) {
  for (JointPose& pose : problem.poses) {
    for (int c = 0; c < problem.channels(); ++c) set_weight(pose.weight[c], pose_mean(c / 3, c % 3));
  }
}

void add_variance(JointProblem& problem, const Channels& nT2) {
  for (JointPose& pose : problem.poses) add(nT2, pose);
}

void add_memory_variance(JointProblem& problem, double factor) {
  for (JointPose& pose : problem.poses)
    if (pose.memory_nT2.size() > 0) add(pose.memory_nT2 * factor, pose);
}

}  // namespace mgtd::calib::fit::joint
