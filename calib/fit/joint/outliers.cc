// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/outliers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/fit/joint/reading_cause.h"
#include "calib/fit/joint/without_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

constexpr double kTakeBack = 0.75;  ///< of the limits: what is left out comes back below
constexpr int kChanges = 2;         ///< of mind about one pose: no judgement may go on for ever
/// Of the five poses before and the five after: a pose among so many bad ones belongs to their stretch.
constexpr std::ptrdiff_t kNeighbours = 5;
constexpr int kBadNeighbours = 7;

/// An axis may lose this share of its readings whatever they look like. Of more, those between kNear of the
/// limit and the limit must be fewer than kInTheGap of those beyond it.
constexpr double kFew = 0.05, kNear = 0.6, kInTheGap = 0.2;

unsigned long long all_readings(int channels) { return (1ULL << static_cast<unsigned>(channels)) - 1; }
bool disturbed(const Rows& rows, int channels) {
  return (rows.to_ullong() & all_readings(channels)) == all_readings(channels);
}
/// The sensor that is left out as a whole; -1 where none or more than one is.
int whole_sensor(const Rows& rows, int channels) {
  for (int i = 0; 3 * i < channels; ++i)
    if ((rows.to_ullong() & all_readings(channels)) == rows_of_sensor(i).to_ullong()) return i;
  return -1;
}

/// Of all these channels of a pose; empty where they do not share one.
std::string common_cause(const JointProblem& problem, std::size_t k, int first, int count) {
  std::string out = cause_of(problem, k, first);
  for (int c = first + 1; c < first + count && !out.empty(); ++c)
    if (cause_of(problem, k, c) != out) out.clear();
  return out;
}

}  // namespace

double Outliers::share() const {
  const auto count = std::count_if(left_out_.begin(), left_out_.end(), [](const Rows& r) { return r.any(); });
  return left_out_.empty() ? 0 : static_cast<double>(count) / static_cast<double>(left_out_.size());
}

void Outliers::restore(JointProblem& problem) const {
  for (std::size_t k = 0; k < left_out_.size(); ++k) {
    if (left_out_[k].none()) continue;
    JointPose& pose = problem.poses[k];
    pose.weight = weight_[k].readings;
    pose.f_weight = weight_[k].scalar;
    pose.attitude_weight = weight_[k].attitude;
  }
}

void Outliers::leave_out(JointProblem& problem) {
  for (std::size_t k = 0; k < left_out_.size(); ++k) {
    if (left_out_[k].none()) continue;
    JointPose& pose = problem.poses[k];
    weight_[k] = {pose.weight, pose.f_weight, pose.attitude_weight};
    const auto channels = static_cast<std::size_t>(problem.channels());
    for (std::size_t c = 0; c < channels; ++c)
      if (left_out_[k][c]) pose.weight[static_cast<Eigen::Index>(c)] = 0;
    if (left_out_[k][channels]) pose.f_weight = 0;
    if (left_out_[k][channels + 1]) pose.attitude_weight = kLooseAttitude_per_rad;
  }
}

void Outliers::keep_out(JointProblem& problem, const ShiftedStretch& stretch) {
  restore(problem);
  for (std::size_t k = stretch.first; k <= stretch.last; ++k) {
    left_out_[k] |= stretch.rows;
    changed_[k] = kChanges;
  }
  leave_out(problem);
}

void Outliers::keep_out(JointProblem& problem, const std::vector<std::size_t>& poses, const Rows& rows) {
  restore(problem);
  for (const std::size_t k : poses) {
    left_out_[k] |= rows;
    changed_[k] = kChanges;
  }
  leave_out(problem);
}

/// Where most poses of a stretch are disturbed in all sensors, or in one, the others of it are not trusted
/// either.
void Outliers::fill_stretches(int channels) {
  const std::vector<Rows> found = left_out_;
  const auto fill = [&](const Rows& rows, const auto& bad) {
    const auto n = static_cast<std::ptrdiff_t>(found.size());
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      int count = 0;
      for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, k - kNeighbours);
           j <= std::min(n - 1, k + kNeighbours); ++j)
        count += j != k && bad(found[static_cast<std::size_t>(j)]) ? 1 : 0;
      if (count >= kBadNeighbours) left_out_[static_cast<std::size_t>(k)] |= rows;
    }
  };
  fill(Rows(all_readings(channels)), [=](const Rows& rows) { return disturbed(rows, channels); });
  for (int i = 0; 3 * i < channels; ++i) {
    fill(rows_of_sensor(i), [=](const Rows& rows) { return whole_sensor(rows, channels) == i; });
  }
}

/// A reading at the end of the range is wrong by an unknown amount, small ones too.
void Outliers::fill_saturated(const JointProblem& problem) {
  constexpr int kCaught = 2;
  for (int c = 0; c < problem.channels(); ++c) {
    const auto row = static_cast<std::size_t>(c);
    const std::vector<std::size_t> stop = at_the_stop(problem, c);
    const auto caught =
        std::count_if(stop.begin(), stop.end(), [&](std::size_t k) { return left_out_[k][row]; });
    if (caught < kCaught) continue;
    for (const std::size_t k : stop) left_out_[k].set(row);
  }
}

/// What is to blame in each of the poses to examine; nothing in the others.
std::vector<Rows> Outliers::blamed(const JointProblem& whole, const JointState& state,
                                   const BlameLimits& limits, const std::vector<std::size_t>& examined) {
  std::vector<Rows> out(left_out_.size());
  PoseBlame blame(whole, state, limits);
  for (const std::size_t k : examined) out[k] = blame.of(k, left_out_[k].any() ? kTakeBack : 1);
  return out;
}

/// Where no gap parts the readings that an axis would lose from those that it keeps, it keeps all. Returns
/// whether there is a new one.
bool Outliers::spare_tails(const PoseResiduals& residuals, const std::vector<Rows>& found,
                           BlameLimits& limits) {
  const auto before = tails_;
  const int channels = static_cast<int>(residuals.scalar_row());
  for (int c = 0; c < channels; ++c) {
    const auto row = static_cast<std::size_t>(c);
    double lost = 0, near = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double t = static_cast<double>(residuals.t(c, static_cast<Eigen::Index>(k))) / limits.spread[c];
      if (found[k][row] && whole_sensor(found[k], channels) < 0 && !disturbed(found[k], channels))
        ++lost;
      else if (found[k].none() && t > kNear * limits.single)
        ++near;
    }
    if (lost > kFew * static_cast<double>(found.size()) && near > kInTheGap * lost) tails_.set(row);
  }
  widen_tails(residuals, limits);
  return tails_ != before;
}

/// No reading of these axes stands out any more.
void Outliers::widen_tails(const PoseResiduals& residuals, BlameLimits& limits) const {
  for (int c = 0; c < residuals.scalar_row(); ++c) {
    if (!tails_[static_cast<std::size_t>(c)]) continue;
    limits.spread[c] = std::max(limits.spread[c], static_cast<double>(residuals.t.row(c).maxCoeff()));
  }
}

bool Outliers::judge(JointProblem& problem, const JointState& state, const PoseResiduals& residuals) {
  left_out_.resize(problem.poses.size());
  return judge(problem, state, residuals, BlameLimits::of(residuals, left_out_));
}

bool Outliers::judge(JointProblem& problem, const JointState& state, const PoseResiduals& residuals,
                     BlameLimits limits) {
  const std::size_t n = problem.poses.size();
  left_out_.resize(n);
  weight_.resize(n);
  changed_.resize(n);
  sigmas_.resize(n);
  if (!(most_ > 0) || given_up_ > kChanges) return false;
  too_many_ = 0;
  widen_tails(residuals, limits);
  const std::vector<Rows> before = left_out_;
  std::vector<std::size_t> examined;  // poses that had something left out or stand out now
  for (std::size_t k = 0; k < n; ++k) {
    const Observations t = residuals.of_pose(static_cast<Eigen::Index>(k)) / limits.spread;
    if (before[k].any() || limits.excess(t) > 1) examined.push_back(k);
    if (before[k].none()) sigmas_[k] = t.maxCoeff();
  }
  if (examined.empty()) return false;
  restore(problem);
  std::vector<Rows> found = blamed(problem, state, limits, examined);
  if (spare_tails(residuals, found, limits)) found = blamed(problem, state, limits, examined);
  for (const std::size_t k : examined) {
    if (before[k].any() && found[k] != before[k] && ++changed_[k] > kChanges) continue;
    left_out_[k] = found[k];
  }
  fill_stretches(problem.channels());
  fill_saturated(problem);
  if (share() > most_) {
    too_many_ = share();
    ++given_up_;
    left_out_.assign(n, {});
  }
  leave_out(problem);
  return left_out_ != before;
}

OutlierNode Outliers::node(const JointProblem& whole, const JointState& state, std::size_t k, int row) const {
  const JointPose& pose = whole.poses[k];
  OutlierNode out{
      .pose = pose.pose->number, .where = {}, .shift = 0, .unit = "nT", .sigmas = sigmas_[k], .place = k};
  PoseLinear linear;
  PoseModel(whole, state).linearise(pose, state.nuisances[k], linear);
  if (row == whole.channels()) {
    out.where = "scalar";
    out.shift = pose.f_nT - linear.f_nT;
  } else if (row == whole.channels() + 1) {
    out.where = "angles";
    out.unit = "deg";
    out.shift = to_deg(2 * std::atan(state.nuisances[k].head<3>().norm() / 2));
  } else {
    out.where = sensor::channel_name(row);
    out.shift = pose.y_nT[row] - linear.y_nT[row];
    out.cause = cause_of(whole, k, row);
  }
  return out;
}

std::vector<OutlierNode> Outliers::nodes(const JointProblem& problem, const JointState& state) const {
  std::vector<OutlierNode> out;
  if (!any()) return out;
  for (std::size_t k = 0; k < left_out_.size(); ++k) {
    const Rows& rows = left_out_[k];
    if (rows.none()) continue;
    JointProblem alone = without_poses(problem);
    alone.poses = {problem.poses[k]};
    JointState at = without_poses(state);
    at.nuisances = {state.nuisances[k]};
    const int channels = problem.channels(), sensor = whole_sensor(rows, channels);
    const auto together = [&](std::string where, int first, int count) {
      PoseLinear linear;
      PoseModel(alone, at).linearise(alone.poses.front(), at.nuisances.front(), linear);
      const double rms =
          (alone.poses.front().y_nT - linear.y_nT).segment(first, count).norm() / std::sqrt(count);
      out.push_back({.pose = problem.poses[k].pose->number,
                     .where = std::move(where),
                     .shift = rms,
                     .unit = "nT",
                     .sigmas = sigmas_[k],
                     .place = k,
                     .cause = common_cause(problem, k, first, count)});
    };
    if (disturbed(rows, channels)) {
      // Its own best field: the table alone does not place the readings to better than its angles.
      alone.poses.front().weight = weight_[k].readings;
      refit_nuisances(alone, at);
      together("pose", 0, channels);
    } else if (sensor >= 0) {
      together(fmt::format("s{}", sensor + 1), 3 * sensor, 3);
    }
    for (int row = 0; row < channels + 2; ++row) {
      const bool covered = row < channels && (disturbed(rows, channels) || sensor >= 0);
      if (rows[static_cast<std::size_t>(row)] && !covered) out.push_back(node(problem, state, k, row));
    }
  }
  tell_passing_sources(out, problem.poses.size());
  return out;
}

}  // namespace mgtd::calib::fit::joint
