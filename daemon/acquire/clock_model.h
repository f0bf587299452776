// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/acquire/feasible_lines.h"

/// A ClockModel estimates when a free-running device took its sample number k, on the host's monotonic clock.
///
///     arrival_k = a + b k + delay_k,   0 <= delay_k <= D
///
/// Nothing arrives before it was taken, and ordinary delivery takes no longer than D = the longest step of
/// the delivery timer (`step_s`) + the host's scheduling
/// (`scheduling_s`, and what the scatter of the latest samples in each second says). So each arrival bounds
/// its sample time on both sides, and all of them leave a set of lines (FeasibleLines) in which the true one
/// lies. The estimate is the line of the set that is closest to the arrivals in the mean: delivery only ever
/// delays. The bound is how far the set reaches to both sides of it.
///
/// Where a timer's step beats with the sampling, delays take few values that hardly change; what all have in
/// common does not show in the arrivals, and the set stays as deep as D less the delays that are seen. It
/// narrows when the beat has swept over the step.
///
/// Late samples (a stalled host) bound nothing from below; a block of which a tenth is late is left out.
/// Arrivals that no line explains (the rate changed, the step is longer than assumed) start the set anew.
/// Where delivery takes visibly longer than D for long, twice what is seen is assumed.
///
/// The period may wander by kWander a second. What delays every sample by the same time (a filter, a
/// conversion) cannot be told from a later clock: it is a configured constant. Seconds, any common origin.
namespace mgtd::daemon::acquire {

struct ClockState {
  double offset_s{0};  ///< arrival of the newest sample less its sample time: the delay of the last delivery
  double rate_error{0};      ///< samples a second against nominal, relative; negative: the device is slow
  double rate_error_pm{0};   ///< the true one lies no further than this from it
  double residual_s{0};      ///< mean delay above the line: the delivery jitter
  double bound_s{0};         ///< the true sample times lie no further than this from the line
  double step_s{0};          ///< of delivery, as assumed
  std::uint64_t samples{0};  ///< seen since the last start
  bool settled{false};
};

class ClockModel {
 public:
  struct Config {
    double period_s{0.02};        ///< nominal
    double step_s{0.016};         ///< longest step of the delivery timer
    double scheduling_s{0.5e-3};  ///< of the host, beside the timer
    double max_drift{0.12};       ///< |b / period - 1|
    double longest_wait_s{1.0};   ///< of the first sample, before it was delivered
    std::uint64_t settle_samples{100};
  };
  /// How far the true time of a sample may lie from time_of(), before and after it.
  struct Bound {
    double early_s{0}, late_s{0};
  };

  explicit ClockModel(Config config);

  /// Forgets the samples and what was learnt of delivery. The next one starts a new set.
  void reset();
  /// Starts a new set at this sample: the device's rate or count is not what it was.
  void restart(std::int64_t k, double arrival_s);
  /// Sample `k` arrived at `arrival_s` (latency already subtracted). `k` rises strictly.
  void add(std::int64_t k, double arrival_s);
  /// The latest samples are late beyond the usual, or their numbers in doubt: they bound nothing from below.
  void distrust() {
    block_.clear();
    late_ = 0;
  }

  [[nodiscard]] bool empty() const { return samples_ == 0; }
  [[nodiscard]] bool settled() const { return samples_ >= config_.settle_samples && blocks_ >= kSettled; }
  /// The latest arrivals are later than any line of the set and ordinary delivery explain: the rate may have
  /// changed, or the step of delivery is longer than assumed. A stall of the host ends it within a second.
  [[nodiscard]] bool contested() const {
    return late_ * kLate > block_size() || overdue_ > 0 || crowded_ > 0;
  }
  [[nodiscard]] double time_of(double k) const { return line_.t_s + line_.period_s * (k - k0_); }
  [[nodiscard]] double index_of(double t_s) const { return k0_ + (t_s - line_.t_s) / line_.period_s; }
  [[nodiscard]] double period_s() const { return line_.period_s; }
  [[nodiscard]] Bound bound(double k) const;
  [[nodiscard]] ClockState state() const;

 private:
  static constexpr int kSettled = 2;        // blocks that bound from below: the rate is known
  static constexpr std::size_t kLate = 10;  // one in so many samples late: the block tells nothing

  struct Arrival {
    double k{0}, t_s{0};
    double above_s{0};  ///< the highest line of the set, or less
  };

  [[nodiscard]] double longest_s() const;
  [[nodiscard]] std::size_t passed_over() const;
  [[nodiscard]] std::size_t block_size() const;
  void forget();
  void start(const Arrival& first);
  void contradicted(const Arrival& by);
  void close_block();
  void bound_from_below();
  void allow_wander();
  void fit();

  Config config_;
  FeasibleLines lines_;
  FeasibleLines::Line line_;  ///< the estimate, at k0_
  double k0_{0}, start_k_{0}, last_k_{0}, widened_k_{0};
  std::vector<Arrival> block_;
  std::size_t late_{0};          ///< of the samples of the block so far
  int crowded_{0}, overdue_{0};  ///< blocks in a row that are wider than D, or late as a whole
  int blocks_{0};                ///< that bound from below since the start
  double step_s_{0};
  double tail_s_{0};  ///< mean, of the latest samples in a block over the one that bounds
  std::uint64_t samples_{0};
  double residual_s_{0}, last_delay_s_{0};
};

}  // namespace mgtd::daemon::acquire
