// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <variant>
#include <vector>

#include "daemon/acquire/sampler.h"
#include "tests/unit/daemon/serve/streams.h"

/// Four free-running devices whose samples wait for timers that beat with them: how often the true skew of an
/// epoch exceeds the bound that it states, and how wide that bound is. Hours of virtual time; nothing is
/// stored but what the sampler keeps.
namespace mgtd::test {

struct TrialDevice {
  double ppm{0};  ///< of its sampling period: positive is slow
  double phase_s{0};
  double step_s{0};     ///< of the delivery timer; 0: at once
  double timer_ppm{0};  ///< of the timer's period
  double timer_phase_s{0};
  double jitter_s{0};                           ///< of the host, after the timer: exponential with this mean
  double wander_ppm{0}, wander_period_s{3600};  ///< sine of the rate
  double change_ppm{0}, change_at_s{0};         ///< the rate is another from then on
};

struct Trial {
  double period_s{0.02};
  std::array<TrialDevice, kSensors> devices;
  double to_s{7200};
  std::uint64_t seed{1};
  daemon::acquire::SamplerConfig config{};
};

struct TrialResult {
  std::uint64_t epochs{0}, violated{0};
  std::uint64_t flagged{0};  ///< clock_unsettled
  std::uint64_t silent{0};   ///< violated, and not flagged
  daemon::acquire::SamplerHealth health;
  double worst_excess_s{0};           ///< of the true skew beyond its bound
  double worst_skew_s{0};             ///< after settling
  double at_1_min_s{0}, at_end_s{0};  ///< the bound
  [[nodiscard]] double violated_share() const {
    return static_cast<double>(violated) / static_cast<double>(std::max<std::uint64_t>(1, epochs));
  }
};

/// One device's samples in the order of their arrivals.
class TrialStream {
 public:
  TrialStream(int slot, const TrialDevice& device, double period_s, std::uint64_t seed)
      : slot_(slot), device_(device), period_s_(period_s * (1 + 1e-6 * device.ppm)), random_(seed) {
    next();
  }
  [[nodiscard]] double arrival_s() const { return arrival_s_; }
  [[nodiscard]] FieldReading take() {
    FieldReading out;
    out.slot = slot_;
    out.seq = k_++;
    out.arrival = stamp_at(arrival_s_);
    out.y_nT.setConstant(kSlope_nT_per_s * t_s_);
    next();
    return out;
  }

 private:
  void next() {
    const double s = device_.phase_s + static_cast<double>(k_) * period_s_;
    const double turn = 2 * std::numbers::pi / device_.wander_period_s;
    t_s_ = s + 1e-6 * device_.wander_ppm / turn * (1 - std::cos(turn * s)) +
           1e-6 * device_.change_ppm * std::max(0.0, s - device_.change_at_s);
    double due_s = t_s_;
    if (device_.step_s > 0) {
      const double step_s = device_.step_s * (1 + 1e-6 * device_.timer_ppm);
      due_s = step_s * std::ceil((t_s_ + device_.timer_phase_s) / step_s) - device_.timer_phase_s;
      due_s = std::max(due_s, t_s_);
    }
    if (device_.jitter_s > 0) due_s += std::exponential_distribution<double>(1 / device_.jitter_s)(random_);
    arrival_s_ = std::max(arrival_s_, due_s);
  }

  int slot_;
  TrialDevice device_;
  double period_s_;
  std::mt19937_64 random_;
  std::uint64_t k_{0};
  double t_s_{0}, arrival_s_{-1e9};
};

[[nodiscard]] inline TrialResult run_trial(const Trial& trial) {
  daemon::acquire::SamplerConfig config = trial.config;
  config.rate_hz = 1 / trial.period_s;
  daemon::acquire::Sampler sampler(config);
  std::vector<TrialStream> streams;
  for (int slot = 0; slot < kSensors; ++slot)
    streams.emplace_back(slot, trial.devices.at(static_cast<std::size_t>(slot)), trial.period_s,
                         trial.seed * kSensors + static_cast<std::uint64_t>(slot));
  TrialResult out;
  std::vector<EpochOrGap> items;
  double t_s = 0;
  while (t_s < trial.to_s) {
    const auto first = std::min_element(streams.begin(), streams.end(), [](const auto& a, const auto& b) {
      return a.arrival_s() < b.arrival_s();
    });
    t_s = first->arrival_s();
    sampler.push(first->take(), items);
    for (const EpochOrGap& item : items) {
      const auto* e = std::get_if<Epoch>(&item);
      if (e == nullptr) continue;
      double low_s = std::numeric_limits<double>::max(), high_s = std::numeric_limits<double>::lowest();
      for (const auto& y : e->y_nT) {
        low_s = std::min(low_s, y.x() / kSlope_nT_per_s);
        high_s = std::max(high_s, y.x() / kSlope_nT_per_s);
      }
      const double skew_s = high_s - low_s;
      ++out.epochs;
      out.flagged += e->flags.has(Flag::clock_unsettled);
      const bool violated = skew_s > e->skew_bound_s + 1e-7;
      out.violated += violated;
      out.silent += violated && !e->flags.has(Flag::clock_unsettled);
      out.worst_excess_s = std::max(out.worst_excess_s, skew_s - e->skew_bound_s);
      if (!e->flags.has(Flag::clock_unsettled)) out.worst_skew_s = std::max(out.worst_skew_s, skew_s);
      if (t_s < 60) out.at_1_min_s = e->skew_bound_s;
      out.at_end_s = e->skew_bound_s;
    }
    items.clear();
  }
  out.health = sampler.health();
  return out;
}

/// What the bound is held against. A beat's length: in that time the part of a delay that all have in common
/// sweeps once through what there is of it, the greatest common measure of step and period (4 ms of 16 at
/// 50 Hz).
struct ClockGrid {
  static constexpr std::array kSteps_s{0.001, 0.004, 0.008, 0.016};
  static constexpr std::array kOscillators_ppm{0.0, 20.0, 50.0, 100.0};
  /// 0: the timers keep the host's time, and the oscillators make the beat; negative: none at all.
  static constexpr std::array kBeats_s{0.0, 20.0, 200.0, 2000.0, 20'000.0, -1.0};
};

/// Four devices at 50 Hz, oscillators up to `ppm` off to both sides.
[[nodiscard]] inline Trial grid_trial(double step_s, double ppm, double beat_s) {
  constexpr std::array<double, kSensors> kShare{1, -1, 0.34, -0.66}, kPhase_s{0.001, 0.0153, 0.0071, 0.0118},
      kTick_s{0.0003, 0.0037, 0.0091, 0.0128};
  Trial trial;
  const double common_s = std::min(step_s, 0.004);
  for (std::size_t i = 0; i < kSensors; ++i) {
    TrialDevice& d = trial.devices.at(i);
    d.ppm = ppm * kShare.at(i);
    d.phase_s = kPhase_s.at(i);
    d.step_s = step_s;
    d.timer_phase_s = kTick_s.at(i);
    const double beat_ppm = beat_s > 0 ? 1e6 * common_s / beat_s * (i % 2 == 0 ? -1 : 1) : 0;
    d.timer_ppm = beat_s == 0 ? 0 : d.ppm - beat_ppm * (1 + 0.1 * static_cast<double>(i));
  }
  return trial;
}

}  // namespace mgtd::test
