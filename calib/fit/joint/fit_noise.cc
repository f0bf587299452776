// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/fit_noise.h"

#include <algorithm>
#include <cmath>

#include "calib/fit/joint/table_ceiling.h"

namespace mgtd::calib::fit::joint {
namespace {

constexpr double kSettled = 0.01;  ///< relative change of a noise estimate that no longer matters
const double kTableFloor_rad = to_rad(0.0005);

/// Changes of an estimate that its own uncertainty makes meaningless: a tenth of it.
double settled(double freedom) { return std::max(kSettled, 0.1 / std::sqrt(2 * std::max(freedom, 1.0))); }

/// Of the directions that a reference beside the table shows: root mean square over the poses.
double reference_sd_rad(const JointProblem& problem) {
  double squares = 0;
  for (const JointPose& pose : problem.poses) squares += pose.reference_sd_rad * pose.reference_sd_rad;
  return std::sqrt(squares / static_cast<double>(problem.poses.size()));
}

/// What is left of a standard deviation without an independent part of it.
double without(double whole, double part) {
  return part > 0 ? std::sqrt(std::max(0.0, whole * whole - part * part)) : whole;
}

}  // namespace

void FitNoise::apply(JointProblem& problem) const {
  if (sample_nT) {
    weight_by_samples(problem, *sample_nT * noise_inflation);
    add_variance(problem, more_nT2 * noise_inflation * noise_inflation);
  } else {
    weight_by_pose(problem, pose_nT);
  }
  add_memory_variance(problem, noise_inflation * noise_inflation);
  for (JointPose& pose : problem.poses) {
    // Loosened attitudes stay loose.
    if (pose.has_angles && pose.attitude_weight > kLooseAttitude_per_rad) pose.weigh_attitude(table_sd_rad);
  }
}

bool FitNoise::update(const PoseResiduals& residuals, const JointProblem& problem) {
  bool moved = false;
  if (!sample_nT) {
    pose_nT = pose_nT.cwiseProduct(residuals.noise_ratio).cwiseMax(kNoiseFloor_nT);
    moved = (residuals.noise_ratio.array() - 1).abs().maxCoeff() > kSettled &&
            pose_nT.maxCoeff() > kNoiseFloor_nT;
  }
  if (problem.has_angles) {
    const double reference_rad = reference_sd_rad(problem), before = std::hypot(table_sd_rad, reference_rad);
    const double now = before * residuals.table_ratio;
    table_sd_rad = std::clamp(without(now, reference_rad), kTableFloor_rad, kTableCeiling_rad);
    moved = moved || std::abs(std::hypot(table_sd_rad, reference_rad) / before - 1) >
                         settled(residuals.attitude_freedom);
  }
  return moved;
}

void settle(FitNoise& noise, JointProblem& problem, JointState& state) {
  constexpr int kMost = 3;
  for (int i = 0; i < kMost; ++i) {
    noise.apply(problem);
    refit_nuisances(problem, state);
    if (!noise.update(pose_residuals(problem, state), problem)) return;
  }
}

calibration::AxisNoise assumed_noise(const JointProblem& problem) {
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(problem.channels());
  Eigen::ArrayXd count = squares;
  for (const JointPose& pose : problem.poses) {
    for (int c = 0; c < problem.channels(); ++c) {
      if (!(pose.weight[c] > 0)) continue;
      squares[c] += 1 / (pose.weight[c] * pose.weight[c]);
      ++count[c];
    }
  }
  return (squares / count.max(1)).sqrt().matrix().reshaped<Eigen::RowMajor>(problem.sensors(), 3);
}

}  // namespace mgtd::calib::fit::joint
