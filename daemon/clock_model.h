// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

/// When a free-running device took its sample number k, on the host's monotonic clock.
///
///     arrival_k = a + b k + delay_k,   delay_k >= 0
///
/// Delivery only ever adds delay (USB latency timers, scheduling), so the line is the lower envelope of the
/// arrivals: the line below all points of the window that lies closest to them on average, with b within
/// max_drift of the nominal period. Its error falls as jitter / samples, not as jitter / sqrt(samples). The
/// window holds block minima: blocks grow with age until kBlocks of them span window_s, so a sample costs one
/// comparison.
///
/// Where delivery waits for a timer (USB: 16 ms), delays come in steps that beat slowly with the samples; for
/// as long as a beat may take the bound holds one step more.
///
/// A delay that is never small within the window cannot be told from latency; it is a configured constant
/// then. Seconds throughout, on any common origin.
namespace mgtd::daemon {

struct ClockState {
  double offset_s{0};   ///< arrival of the newest sample less its sample time: the delay of the last delivery
  double drift_ppm{0};  ///< device period against nominal; positive: the device is slow
  double residual_s{0};      ///< mean delay above the envelope: the delivery jitter
  double bound_s{0};         ///< the envelope lies no further than this above the true sample times
  std::uint64_t samples{0};  ///< seen since the last reset
  bool settled{false};
};

class ClockModel {
 public:
  struct Config {
    double period_s{0.02};   ///< nominal
    double window_s{600};    ///< of the regression
    double max_drift{2e-3};  ///< |b / period - 1|
    std::uint64_t settle_samples{100};
  };

  explicit ClockModel(Config config);

  /// Forgets the samples. The next one starts a new line.
  void reset();
  /// Sample `k` arrived at `arrival_s` (latency already subtracted). `k` rises strictly.
  void add(std::int64_t k, double arrival_s);

  [[nodiscard]] bool empty() const { return samples_ == 0; }
  [[nodiscard]] bool settled() const { return samples_ >= config_.settle_samples; }
  [[nodiscard]] double time_of(double k) const { return a_s_ + b_s_ * (k - k0_); }
  [[nodiscard]] double index_of(double t_s) const { return k0_ + (t_s - a_s_) / b_s_; }
  [[nodiscard]] double period_s() const { return b_s_; }
  [[nodiscard]] double bound_s() const { return bound_s_; }
  [[nodiscard]] ClockState state() const;

 private:
  struct Point {
    double k{0};
    double arrival_s{0};
  };
  static constexpr std::size_t kBlocks = 128;
  static constexpr std::size_t kGroups = 8;

  [[nodiscard]] double above_line(const Point& p) const { return p.arrival_s - time_of(p.k); }
  void close_block();
  void halve();
  void fit();
  void fit_bound();

  Config config_;
  double k0_{0}, a_s_{0}, b_s_{0};
  std::vector<Point> points_;  ///< minima of closed blocks, oldest first
  std::vector<Point> hull_;    ///< scratch of fit()
  Point lowest_;               ///< of the open block
  std::size_t in_block_{0}, block_{1}, block_max_{1};
  std::uint64_t samples_{0};
  double bound_s_{0}, residual_s_{0}, last_delay_s_{0};
  double near_{0};  ///< share of delays that are close to none
};

}  // namespace mgtd::daemon
