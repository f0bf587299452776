// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_progress.h"

#include <algorithm>

namespace mgtd::daemon::run {
namespace {
constexpr double kPriorPoses = 3;  // weight of what was foreseen
}

RunProgress::RunProgress(const plan::RunPlan& plan, plan::Pace pace)
    : solve_s_(pace.solve_s), foreseen_s_(0), measured_s_(0) {
  extend(plan, pace);
  double sum_s = 0;
  for (const double overhead_s : overhead_s_) sum_s += overhead_s;
  if (!done_.empty()) foreseen_s_ = measured_s_ = kPriorPoses * sum_s / static_cast<double>(done_.size());
}

void RunProgress::extend(const plan::RunPlan& plan, plan::Pace pace) {
  for (std::size_t i = done_.size(); i < plan.poses.size(); ++i) {
    dwell_s_.push_back(plan.poses[i].dwell_s);
    overhead_s_.push_back(plan::pose_s(pace, plan, i) - plan.poses[i].dwell_s);
    done_.push_back(false);
  }
}

void RunProgress::begin(std::size_t index, Instant now) {
  index_ = index;
  current_ = index;
  begun_ = now;
}

void RunProgress::finish(std::size_t index, Instant now) {
  if (current_ == index) {
    measured_s_ += std::max(0.0, to_seconds(now - begun_) - dwell_s_.at(index));
    foreseen_s_ += overhead_s_.at(index);
  }
  done_.at(index) = true;
  current_.reset();
  last_ = index;
  attempt_ = 0;
}

int RunProgress::failed() {
  ++retries_;
  return ++attempt_;
}

std::size_t RunProgress::done() const {
  return static_cast<std::size_t>(std::count(done_.begin(), done_.end(), true));
}

std::optional<std::size_t> RunProgress::next() const {
  if (cut_) return std::nullopt;
  const auto at = std::find(done_.begin(), done_.end(), false);
  if (at == done_.end()) return std::nullopt;
  return static_cast<std::size_t>(at - done_.begin());
}

double RunProgress::factor() const { return foreseen_s_ > 0 ? measured_s_ / foreseen_s_ : 1; }

double RunProgress::remaining_s(Instant now) const {
  double sum_s = solve_s_;
  for (std::size_t i = 0; i < done_.size(); ++i) {
    if (done_[i]) continue;
    const double pose_s = dwell_s_[i] + factor() * overhead_s_[i];
    sum_s += current_ == i ? std::max(0.0, pose_s - to_seconds(now - begun_)) : pose_s;
  }
  return sum_s;
}

}  // namespace mgtd::daemon::run
