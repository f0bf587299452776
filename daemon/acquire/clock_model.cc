// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/clock_model.h"

#include <algorithm>
#include <cmath>

namespace mgtd::daemon::acquire {
namespace {

constexpr double kWander = 3e-9;      // of the period, relative, in a second: 11 ppm in an hour
constexpr double kOrdinary = 200e-6;  // rate errors of oscillators; preferred as long as they explain all
constexpr double kBlock_s = 1.0;
constexpr double kMean_s = 600;  // over which the estimate is closest to the arrivals: two beats of 13 ppm
constexpr double kBelow = 0.1;   // of the set's depth, or ...
constexpr double kBelow_s = 0.5e-3;            // ... so much: no further is the estimate below its upper side
constexpr double kTails = 4.5;                 // so far does chance reach in hours, in mean tails of a second
constexpr int kTailBlocks = 64;                // over which they are averaged
constexpr int kCrowded = 30;                   // blocks in a row: D is too small
constexpr int kOverdue = 2;                    // blocks in a row that came late as a whole: another rate
constexpr double kResidualWeight = 1.0 / 256;  // of the running mean of delays

}  // namespace

ClockModel::ClockModel(Config config) : config_(config) {
  block_.reserve(block_size());
  reset();
}

void ClockModel::reset() {
  step_s_ = config_.step_s;
  tail_s_ = 0;
  residual_s_ = 0;
  crowded_ = 0;
  forget();
}

void ClockModel::restart(std::int64_t k, double arrival_s) {
  forget();
  start({static_cast<double>(k), arrival_s});
}

void ClockModel::forget() {
  distrust();
  samples_ = 0;
  overdue_ = blocks_ = 0;
  last_delay_s_ = 0;
  line_.period_s = config_.period_s;
}

double ClockModel::longest_s() const { return step_s_ + config_.scheduling_s + kTails * tail_s_; }

/// The latest samples of a block that may be the end of one stall of the host.
std::size_t ClockModel::passed_over() const {
  return 2 + static_cast<std::size_t>(longest_s() / config_.period_s);
}

std::size_t ClockModel::block_size() const {
  return std::max(
      {static_cast<std::size_t>(kBlock_s / config_.period_s), std::size_t{16}, 8 * passed_over()});
}

void ClockModel::start(const Arrival& first) {
  const double spread_s = config_.max_drift * config_.period_s;
  lines_.start(first.k, {first.t_s - config_.longest_wait_s, first.t_s},
               {config_.period_s - spread_s, config_.period_s + spread_s});
  start_k_ = widened_k_ = last_k_ = first.k;
  samples_ = 1;
  fit();
}

void ClockModel::contradicted(const Arrival& by) {
  forget();
  start(by);
}

void ClockModel::add(std::int64_t k, double arrival_s) {
  const Arrival a{static_cast<double>(k), arrival_s};
  last_k_ = a.k;
  if (samples_++ == 0) {
    start(a);
  } else if (!lines_.not_above(a.k, a.t_s)) {
    contradicted(a);
  } else if (a.t_s < time_of(a.k) || samples_ < block_size()) {
    fit();
  }
  last_delay_s_ = a.t_s - time_of(a.k);
  const double weight = std::max(kResidualWeight, 1.0 / static_cast<double>(samples_));
  residual_s_ += (last_delay_s_ - residual_s_) * weight;
  block_.push_back(a);
  if (a.t_s - lines_.time(a.k).most > longest_s()) ++late_;
  if (a.k - widened_k_ >= static_cast<double>(block_size())) allow_wander();
  if (block_.size() >= block_size()) close_block();
}

void ClockModel::close_block() {
  const Arrival last = block_.back();
  bound_from_below();
  if (overdue_ >= kOverdue || crowded_ >= kCrowded) {
    crowded_ = 0;
    contradicted(last);
  }
  distrust();
  fit();
}

void ClockModel::allow_wander() {
  const double since_s = (last_k_ - widened_k_) * config_.period_s;
  lines_.allow_wander(last_k_, kWander * since_s * config_.period_s);
  widened_k_ = last_k_;
}

/// Of the samples in time, the latest but some: it was taken no earlier than D before. A block that is late
/// as a whole is of another rate; one that is wider than D, of slower delivery.
void ClockModel::bound_from_below() {
  const auto later = [](const Arrival& p, const Arrival& q) { return p.above_s > q.above_s; };
  for (Arrival& a : block_) a.above_s = a.t_s - lines_.time(a.k).most;
  const auto in_time =
      std::partition(block_.begin(), block_.end(), [&](const Arrival& a) { return a.above_s > longest_s(); });
  const auto latest_but = [&](std::vector<Arrival>::iterator from, std::size_t some) {
    const auto nth = from + std::min(static_cast<std::ptrdiff_t>(some), block_.end() - from - 1);
    std::nth_element(from, nth, block_.end(), later);
    return *nth;
  };
  if (static_cast<std::size_t>(in_time - block_.begin()) * kLate <= block_.size()) {
    const Arrival a = latest_but(in_time, passed_over());
    // Single ones that are late every second, behind a line that is longer, are no tail.
    const double tail_s = std::min(latest_but(in_time, 0).above_s - a.above_s,
                                   2 * (a.above_s - latest_but(in_time, 2 * passed_over() + 1).above_s));
    ++blocks_;
    tail_s_ += (tail_s - tail_s_) / std::min(blocks_, kTailBlocks);
    const double longest_s = this->longest_s() + kTails * std::max(0.0, tail_s - tail_s_);
    static_cast<void>(lines_.not_below(a.k, a.t_s - longest_s));
    overdue_ = crowded_ = 0;
    return;
  }
  const double least_s =
      std::min_element(block_.begin(), block_.end(), [&](const Arrival& p, const Arrival& q) {
        return later(q, p);
      })->above_s;
  const double usual_s = latest_but(block_.begin(), passed_over()).above_s;
  const bool shifted = least_s > longest_s() || usual_s - least_s <= longest_s();
  overdue_ = shifted ? overdue_ + 1 : 0;
  crowded_ = shifted ? 0 : crowded_ + 1;
  if (crowded_ == kCrowded) step_s_ = 2 * usual_s;
}

void ClockModel::fit() {
  const double back = std::min((last_k_ - start_k_) / 2, kMean_s / 2 / config_.period_s);
  const double from_k = last_k_ - back;
  line_ = lines_.highest_at(from_k, {config_.period_s * (1 - kOrdinary), config_.period_s * (1 + kOrdinary)});
  k0_ = from_k;
  const FeasibleLines::Range now_s = lines_.time(last_k_);
  const double least_s = now_s.most - std::max(kBelow_s, kBelow * (now_s.most - now_s.least));
  line_.t_s += std::max(0.0, least_s - time_of(last_k_));
}

ClockModel::Bound ClockModel::bound(double k) const {
  if (empty()) return {config_.longest_wait_s, config_.longest_wait_s};
  const FeasibleLines::Range t_s = lines_.time(k);
  const double at_s = time_of(k);
  return {std::max(0.0, at_s - t_s.least), std::max(0.0, t_s.most - at_s)};
}

ClockState ClockModel::state() const {
  const Bound b = bound(last_k_);
  const double nominal_s = config_.period_s;
  ClockState out{last_delay_s_,
                 nominal_s / line_.period_s - 1,
                 0,
                 residual_s_,
                 std::max(b.early_s, b.late_s),
                 step_s_,
                 samples_,
                 settled()};
  if (!empty()) {
    const FeasibleLines::Range period_s = lines_.period();
    out.rate_error_pm = std::max(nominal_s / period_s.least - nominal_s / line_.period_s,
                                 nominal_s / line_.period_s - nominal_s / period_s.most);
  }
  return out;
}

}  // namespace mgtd::daemon::acquire
