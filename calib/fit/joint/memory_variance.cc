// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/memory_variance.h"

#include <algorithm>
#include <cmath>

#include "calib/effects/level_terms.h"

namespace mgtd::calib::fit::joint {
namespace {

constexpr double kMoves = 0.02;  // of the variance of a reading

Channels memory_nT2(const JointProblem& problem, const JointPose& pose, const effects::LevelTerms& axis,
                    const JointState& state, double table_sd_rad) {
  Channels out(problem.channels());
  for (int c = 0; c < problem.channels(); ++c)
    out[c] =
        std::pow(axis.sd_nT_per_rad(pose.conditions(), c / 3, c % 3, state.coefficients) * table_sd_rad, 2);
  return out;
}

}  // namespace

bool set_memory_variance(JointProblem& problem, const JointState& state, double table_sd_rad) {
  const effects::LevelTerms axis(problem.effects, effects::Level::axis);
  if (axis.empty()) return false;
  bool moved = false;
  for (JointPose& pose : problem.poses) {
    const Channels now = memory_nT2(problem, pose, axis, state, table_sd_rad);
    if (pose.memory_nT2.size() == 0 && now.isZero(0)) continue;
    if (pose.memory_nT2.size() == 0) pose.memory_nT2.setZero(now.size());
    const Channels change = (now - pose.memory_nT2).cwiseAbs().cwiseProduct(pose.weight.cwiseAbs2());
    moved = moved || change.maxCoeff() > kMoves;
    pose.memory_nT2 = now;
  }
  return moved;
}

}  // namespace mgtd::calib::fit::joint
