// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/outliers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mgtd::calib {
namespace {

constexpr double kLimit = 6;     ///< robust spreads: one false node in 10^8 Gaussian observations
constexpr double kTakeBack = 4;  ///< spreads below which an observation fits after all
/// Smaller than this share of the worst may be its shadow: wait for the next round.
constexpr double kWithWorst = 0.2;
constexpr double kMaxShare = 0.1;  ///< of the poses
/// Of the largest misfit of its pose, in units of the noise: what is smaller is bent by that one. The worst
/// of an axis that misfits everywhere stands out least where it is one of many, and its neighbours in its
/// stead.
constexpr double kOfLargest = 0.8;
constexpr double kMadToSd = 1.4826;

/// Robust spread of t over the poses, by kind of observation, at least the nominal one.
Eigen::Array<double, kObservations, 1> spreads(const PoseResiduals& residuals) {
  Eigen::Array<double, kObservations, 1> spread = Eigen::Array<double, kObservations, 1>::Ones();
  for (int row = 0; row < kObservations; ++row) {
    std::vector<float> values;
    for (const float t : residuals.t.row(row)) {
      if (t > 0) values.push_back(t);
    }
    if (values.empty()) continue;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    spread[row] = std::max(1.0, kMadToSd * static_cast<double>(*middle));
  }
  return spread;
}

double& weight_of(JointPose& pose, int row) {
  if (row == kScalarRow) return pose.f_weight;
  return row == kAttitudeRow ? pose.attitude_weight : pose.weight[row];
}

}  // namespace

std::vector<Outliers::Suspect> Outliers::find(const PoseResiduals& residuals) const {
  std::vector<Suspect> found;
  double worst = 0;
  for (Eigen::Index k = 0; k < residuals.t.cols(); ++k) {
    Spreads by_noise = residuals.t.col(k).cast<double>().array();
    for (const Suspect& s : taken_back_) {
      if (static_cast<Eigen::Index>(s.pose) == k) by_noise[s.row] = 0;
    }
    Eigen::Index row = 0;
    const double largest = (by_noise / spread_).maxCoeff(&row);
    const double of_readings = by_noise.head<kChannels>().maxCoeff();
    if (largest > kLimit && by_noise[row] >= kOfLargest * of_readings)
      found.push_back({.pose = static_cast<std::size_t>(k), .row = static_cast<int>(row), .t = largest});
    worst = std::max(worst, largest);
  }
  std::erase_if(found, [&](const Suspect& s) { return s.t < kWithWorst * worst; });
  return found;
}

bool Outliers::exclude(JointProblem& problem, const PoseResiduals& residuals) {
  spread_ = spreads(residuals);
  auto found = find(residuals);
  if (static_cast<double>(found.size() + left_out_.size()) >
      kMaxShare * static_cast<double>(problem.poses.size()))
    return false;
  for (Suspect& s : found) {
    double& weight = weight_of(problem.poses[s.pose], s.row);
    s.weight = weight;
    weight = s.row == kAttitudeRow ? kLooseAttitude_per_rad : 0;
    left_out_.push_back(s);
  }
  return !found.empty();
}

bool Outliers::restore(JointProblem& problem, const JointState& state) {
  const PoseModel model(problem, state);
  PoseLinear linear;
  const auto fits = [&](const Suspect& s) {
    if (s.row == kAttitudeRow)
      return false;  // the pose's own attitude follows its readings: nothing new was learnt
    const JointPose& pose = problem.poses[s.pose];
    model.linearise(pose, state.nuisances[s.pose], linear);
    const double shift =
        s.row == kScalarRow ? pose.f_nT - linear.f_nT : pose.y_nT[s.row] - linear.y_nT[s.row];
    // The scalar's prediction carries the readings' noise, its own is smaller.
    const double weight = s.row == kScalarRow ? std::min(s.weight, pose.weight.maxCoeff()) : s.weight;
    return std::abs(shift) * weight < kTakeBack;
  };
  const auto gone =
      std::stable_partition(left_out_.begin(), left_out_.end(), [&](const Suspect& s) { return !fits(s); });
  const bool any = gone != left_out_.end();
  take_back(problem, gone);
  return restore_all_but_one(problem, state) || any;
}

void Outliers::take_back(JointProblem& problem, std::vector<Suspect>::iterator from) {
  for (auto s = from; s != left_out_.end(); ++s) {
    weight_of(problem.poses[s->pose], s->row) = s->weight;
    taken_back_.push_back(*s);
  }
  left_out_.erase(from, left_out_.end());
}

/// The worst observation of a pose that has everything but the culprit, with the nuisances that fit best
/// then.
double Outliers::worst_without(const JointProblem& problem, const JointState& state,
                               const Suspect& culprit) const {
  JointProblem alone = problem;
  alone.poses = {problem.poses[culprit.pose]};
  for (const Suspect& s : left_out_)
    if (s.pose == culprit.pose && s.row != culprit.row) weight_of(alone.poses.front(), s.row) = s.weight;
  JointState at = state;
  at.nuisances = {state.nuisances[culprit.pose]};
  refit_nuisances(alone, at);
  return (pose_residuals(alone, at).t.col(0).cast<double>().array() / spread_).maxCoeff();
}

bool Outliers::restore_all_but_one(JointProblem& problem, const JointState& state) {
  bool any = false;
  std::vector<std::size_t> poses;
  for (const Suspect& s : left_out_) poses.push_back(s.pose);
  std::sort(poses.begin(), poses.end());
  for (auto pose = poses.begin(); pose != poses.end(); pose = std::upper_bound(pose, poses.end(), *pose)) {
    if (std::count(poses.begin(), poses.end(), *pose) < 2) continue;
    const Suspect* culprit = nullptr;
    double least = kLimit;
    for (const Suspect& s : left_out_) {
      if (s.pose != *pose) continue;
      const double worst = worst_without(problem, state, s);
      if (worst < least) least = worst, culprit = &s;
    }
    if (culprit == nullptr) continue;
    const int row = culprit->row;
    take_back(problem, std::stable_partition(left_out_.begin(), left_out_.end(), [&](const Suspect& s) {
                return s.pose != *pose || s.row == row;
              }));
    any = true;
  }
  return any;
}

std::vector<OutlierNode> Outliers::nodes(const JointProblem& problem, const JointState& state) const {
  const PoseModel model(problem, state);
  std::vector<OutlierNode> out;
  for (const Suspect& s : left_out_) {
    const JointPose& pose = problem.poses[s.pose];
    OutlierNode node{.pose = pose.pose->number, .where = {}, .shift = 0, .unit = "nT", .sigmas = s.t};
    PoseLinear linear;
    model.linearise(pose, state.nuisances[s.pose], linear);
    if (s.row == kScalarRow) {
      node.where = "scalar";
      node.shift = pose.f_nT - linear.f_nT;
    } else if (s.row == kAttitudeRow) {
      node.where = "angles";
      node.unit = "deg";
      node.shift = to_deg(2 * std::atan(state.nuisances[s.pose].head<3>().norm() / 2));
    } else {
      node.where = fmt::format("s{}.{}", s.row / 3 + 1, "xyz"[s.row % 3]);
      node.shift = pose.y_nT[s.row] - linear.y_nT[s.row];
    }
    out.push_back(std::move(node));
  }
  return out;
}

}  // namespace mgtd::calib
