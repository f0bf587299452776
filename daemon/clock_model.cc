// SPDX-License-Identifier: Apache-2.0
#include "daemon/clock_model.h"

#include <algorithm>
#include <cmath>

namespace mgtd::daemon {
namespace {

constexpr double kBeat_s = 300;    // 4 ms, what 16 leave of 20, at 17 ppm: 235 s
constexpr double kNear = 1.0 / 8;  // of the mean delay: next to the envelope
constexpr double kSteps = 0.16;    // share of delays there that chance does not explain: kNear / 2
constexpr double kResidualWeight = 1.0 / 256;  // of the running mean of delays

}  // namespace

ClockModel::ClockModel(Config config) : config_(config), b_s_(config.period_s) {
  const double in_window = std::max(1.0, config.window_s / config.period_s);
  block_max_ = static_cast<std::size_t>(std::ceil(in_window / static_cast<double>(kBlocks)));
  points_.reserve(kBlocks + 1);
  hull_.reserve(kBlocks + 1);
  reset();
}

void ClockModel::reset() {
  points_.clear();
  in_block_ = 0;
  block_ = 1;
  samples_ = 0;
  b_s_ = config_.period_s;
  bound_s_ = config_.period_s;
  residual_s_ = last_delay_s_ = near_ = 0;
}

void ClockModel::add(std::int64_t k, double arrival_s) {
  const Point p{static_cast<double>(k), arrival_s};
  if (samples_ == 0) {
    k0_ = p.k;
    a_s_ = arrival_s;
  }
  double delay = above_line(p);
  if (delay < 0) {  // nothing arrives before it was taken: the line was too high
    a_s_ += delay;
    delay = 0;
  }
  ++samples_;
  last_delay_s_ = delay;
  const double weight = std::max(kResidualWeight, 1.0 / static_cast<double>(samples_));
  residual_s_ += (delay - residual_s_) * weight;
  near_ += ((delay < kNear * residual_s_ ? 1.0 : 0.0) - near_) * weight;
  if (in_block_ == 0 || delay < above_line(lowest_)) lowest_ = p;
  if (++in_block_ == block_) close_block();
}

void ClockModel::close_block() {
  points_.push_back(lowest_);
  in_block_ = 0;
  if (points_.size() > kBlocks) {
    if (block_ < block_max_) {
      halve();
    } else {
      points_.erase(points_.begin());
    }
  }
  fit();
  fit_bound();
}

/// Pairs of blocks become one; the last block, left single, is opened again.
void ClockModel::halve() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 1 < points_.size(); i += 2) {
    const Point &p = points_[i], &q = points_[i + 1];
    points_[kept++] = above_line(p) < above_line(q) ? p : q;
  }
  if (points_.size() % 2 == 1) {
    lowest_ = points_.back();
    in_block_ = block_;
  }
  points_.resize(kept);
  block_ *= 2;
}

/// The edge of the lower convex hull below the mean k is the line below all points that is closest to them in
/// the mean.
void ClockModel::fit() {
  if (points_.size() < 2) return;
  hull_.clear();
  double k_sum = 0;
  for (const Point& p : points_) {
    while (hull_.size() >= 2) {
      const Point &o = hull_[hull_.size() - 2], &q = hull_.back();
      if ((q.k - o.k) * (p.arrival_s - o.arrival_s) > (q.arrival_s - o.arrival_s) * (p.k - o.k)) break;
      hull_.pop_back();
    }
    hull_.push_back(p);
    k_sum += p.k;
  }
  const double k_mean = k_sum / static_cast<double>(points_.size());
  auto right = std::lower_bound(hull_.begin() + 1, hull_.end() - 1, k_mean,
                                [](const Point& p, double k) { return p.k < k; });
  const Point &p = *(right - 1), &q = *right;
  const double slope = (q.arrival_s - p.arrival_s) / (q.k - p.k);
  b_s_ = std::clamp(slope, config_.period_s * (1 - config_.max_drift),
                    config_.period_s * (1 + config_.max_drift));
  k0_ = points_.back().k;
  a_s_ = points_.back().arrival_s;
  double lowest = 0;
  for (const Point& h : hull_) lowest = std::min(lowest, above_line(h));
  if (in_block_ > 0) lowest = std::min(lowest, above_line(lowest_));
  a_s_ += lowest;
}

/// How far above the line the lowest arrival of an eighth of the window lies, at worst. A delivery timer that
/// beats with the samples hides part of its delay for as long as one beat: until then that part counts too.
void ClockModel::fit_bound() {
  if (points_.size() < 2 * kGroups) return;
  double worst = 0;
  for (std::size_t group = 0; group < kGroups; ++group) {
    const std::size_t first = points_.size() * group / kGroups, last = points_.size() * (group + 1) / kGroups;
    double least = above_line(points_[first]);
    for (std::size_t i = first + 1; i < last; ++i) least = std::min(least, above_line(points_[i]));
    worst = std::max(worst, least);
  }
  const double seen_s = (points_.back().k - points_.front().k) * b_s_;
  // Delays of a beating timer come in steps, each as often as the next; those of chance spread.
  const double step_s = near_ > kSteps ? 2 * residual_s_ * near_ : 0;
  bound_s_ = worst + step_s * std::max(0.0, 1 - seen_s / kBeat_s);
}

ClockState ClockModel::state() const {
  return {last_delay_s_, (b_s_ / config_.period_s - 1) * 1e6, residual_s_, bound_s_, samples_, settled()};
}

}  // namespace mgtd::daemon
