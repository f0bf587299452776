// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/reading_cause.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace mgtd::calib::fit::joint {

std::vector<std::size_t> at_the_stop(const JointProblem& problem, int channel) {
  constexpr std::size_t kShared = 3;
  std::vector<double> y;
  for (const JointPose& pose : problem.poses) y.push_back(pose.y_nT[channel]);
  std::vector<std::size_t> out;
  if (y.empty()) return out;
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  for (const double stop : {*low, *high}) {
    if (stop == *high && std::abs(stop) == std::abs(*low))
      break;  // of a range that is symmetric both ends are one
    std::vector<std::size_t> same;
    for (std::size_t k = 0; k < y.size(); ++k)
      if (std::abs(y[k]) == std::abs(stop)) same.push_back(k);
    if (same.size() >= kShared) out.insert(out.end(), same.begin(), same.end());
  }
  return out;
}

namespace {

/// The largest reading of its channel, one way or the other, in whose dwell nothing moved though it moved in
/// others.
bool stands_still_at_the_end(const JointProblem& problem, std::size_t pose, int channel) {
  const auto axis = std::div(channel, 3);
  const auto sd_nT = [&](const JointPose& p) {
    return p.pose->sd_nT.at(static_cast<std::size_t>(axis.quot)).at(static_cast<std::size_t>(axis.rem));
  };
  const JointPose& own = problem.poses[pose];
  if (sd_nT(own) != 0.0) return false;
  bool moves = false;
  for (const JointPose& other : problem.poses) {
    if (std::abs(other.y_nT[channel]) > std::abs(own.y_nT[channel])) return false;
    moves = moves || sd_nT(other).value_or(0) > 0;
  }
  return moves;
}

}  // namespace

std::string cause_of(const JointProblem& problem, std::size_t pose, int channel) {
  if (stands_still_at_the_end(problem, pose, channel)) return "saturated";
  const std::vector<std::size_t> stop = at_the_stop(problem, channel);
  if (std::find(stop.begin(), stop.end(), pose) != stop.end()) return "saturated";
  const auto same = [&](std::size_t other) {
    return other < problem.poses.size() &&
           problem.poses[other].y_nT[channel] == problem.poses[pose].y_nT[channel];
  };
  return same(pose + 1) || (pose > 0 && same(pose - 1)) ? "stuck" : "";
}

void tell_passing_sources(std::vector<OutlierNode>& nodes, std::size_t poses) {
  constexpr std::size_t kShortest = 3;
  std::vector<OutlierNode*> stretch;
  const auto end_stretch = [&] {
    if (stretch.size() >= kShortest && stretch.front()->place > 0 && stretch.back()->place + 1 < poses)
      for (OutlierNode* node : stretch) node->cause = "a source that came and went";
    stretch.clear();
  };
  for (OutlierNode& node : nodes) {
    if (node.where != "pose" || !node.cause.empty()) continue;
    if (!stretch.empty() && stretch.back()->place + 1 != node.place) end_stretch();
    stretch.push_back(&node);
  }
  end_stretch();
}

}  // namespace mgtd::calib::fit::joint
