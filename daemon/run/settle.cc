// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/settle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/calibration/tensor.h"

namespace mgtd::daemon::run {
namespace {

constexpr double kWindowShare = 0.8;  // of the expected epochs; the rest may be gaps

}  // namespace

Settle::Settle(SettleConfig config, Instant commanded) : config_(config), commanded_(commanded) {
  config_.window_s = whole_window_s(config);
}

void Settle::add(const TableReading& reading) {
  if (reading.arrival.mono < commanded_) return;
  const bool rests = reading.on_target && !reading.moving;
  if (rests && !stopped_) stopped_ = reading.arrival.mono;
  if (!rests) {
    stopped_.reset();
    window_.clear();
  }
}

void Settle::add(const EpochOrGap& item) {
  const auto* epoch = std::get_if<Epoch>(&item);
  if (epoch == nullptr || !stopped_ || epoch->t.mono < *stopped_) return;
  if (epoch->flags.has(Flag::frozen)) return;  // stands still, but not because the field does
  const WindowEntry entry{epoch->t.mono, calib::calibration::stacked(epoch->y_nT)};
  window_.push_back(entry);
  while (entry.t - window_.front().t > from_seconds(config_.window_s)) window_.pop_front();
}

bool Settle::window_full() const {
  const auto n = static_cast<double>(window_.size());
  if (window_.size() < kFewestInWindow || n < kWindowShare * config_.window_s * config_.rate_hz) return false;
  return to_seconds(window_.back().t - window_.front().t) > kWindowShare * config_.window_s;
}

/// Straight line through the window per axis; the axis that exceeds its drift limit most, and the largest
/// scatter.
Settle::Worst Settle::measure() const {
  const auto n = static_cast<double>(window_.size());
  const Eigen::Index axes = window_.front().y_nT.size();
  Sample mean = Sample::Zero(axes), slope = mean, square = mean;
  double t_mean_s = 0, t_square = 0;
  for (const WindowEntry& p : window_) {
    mean += p.y_nT / n;
    t_mean_s += to_seconds(p.t - window_.front().t) / n;
  }
  for (const WindowEntry& p : window_) {
    const double t_s = to_seconds(p.t - window_.front().t) - t_mean_s;
    slope += t_s * (p.y_nT - mean);
    t_square += t_s * t_s;
  }
  slope /= t_square;
  for (const WindowEntry& p : window_) {
    const double t_s = to_seconds(p.t - window_.front().t) - t_mean_s;
    square += (p.y_nT - mean - slope * t_s).cwiseAbs2();
  }
  Worst worst;
  for (int axis = 0; axis < axes; ++axis) {
    const double sd_nT = std::sqrt(square[axis] / (n - 2));
    const double change_nT = std::abs(slope[axis]) * config_.window_s;
    const double limit_nT =
        std::max(config_.tolerance_nT, config_.slope_sigmas * sd_nT / std::sqrt(t_square) * config_.window_s);
    if (sd_nT > worst.sd_nT) {
      worst.sd_nT = sd_nT;
      worst.noisy_axis = axis;
    }
    if (change_nT / limit_nT <= worst.drift_excess) continue;
    worst.drift_excess = change_nT / limit_nT;
    worst.drifting_axis = axis;
    worst.change_nT = change_nT;
    worst.limit_nT = limit_nT;
  }
  return worst;
}

SettleOutcome Settle::judge(Instant now) {
  if (final_) return *final_;
  SettleOutcome outcome = stopped_ ? judge_field(now) : judge_table(now);
  if (outcome.state != SettleState::settling) final_ = outcome;
  return outcome;
}

SettleOutcome Settle::judge_table(Instant now) const {
  const double waited_s = to_seconds(now - commanded_);
  return {waited_s > config_.move_max_s ? SettleState::timed_out : SettleState::settling,
          fmt::format("the table is not on target {:.1f} s after the command", waited_s),
          fmt::format("{:.0f} s", config_.move_max_s),
          "look whether the table is blocked, and at its error register"};
}

SettleOutcome Settle::judge_field(Instant now) const {
  const double since_s = to_seconds(now - *stopped_);
  const bool last_chance = since_s > config_.max_s;
  const SettleState open = last_chance ? SettleState::timed_out : SettleState::settling;
  if (!window_full()) {
    return {open,
            fmt::format("{} epochs in the last {:.1f} s, {:.1f} s after the stop", window_.size(),
                        config_.window_s, since_s),
            fmt::format("{:.0f} epochs", std::ceil(kWindowShare * config_.window_s * config_.rate_hz)),
            "see which sensor the GAP records name"};
  }
  const Worst worst = measure();
  if (worst.drift_excess > 1) {
    return {open,
            fmt::format("{} drifts {:.2f} nT over {:.1f} s, {:.1f} s after the stop",
                        calib::sensor::channel_name(worst.drifting_axis), worst.change_nT, config_.window_s,
                        since_s),
            fmt::format("{:.2f} nT", worst.limit_nT),
            "lengthen settle_max_s, or look for a motor that stays on or iron that moves"};
  }
  const double most_nT = config_.disturbed_ratio * config_.noise_nT;
  if (config_.noise_nT > 0 && worst.sd_nT > most_nT) {
    return {
        last_chance ? SettleState::disturbed : SettleState::settling,
        fmt::format("{} scatters by {:.2f} nT", calib::sensor::channel_name(worst.noisy_axis), worst.sd_nT),
        fmt::format("{:.2f} nT, {:.0f} x the noise of the preflight", most_nT, config_.disturbed_ratio),
        "something magnetic moves near the array, or the table's drive is still powered"};
  }
  return {since_s < config_.min_s ? open : SettleState::settled,
          fmt::format("{} drifts {:.2f} nT over {:.1f} s", calib::sensor::channel_name(worst.drifting_axis),
                      worst.change_nT, config_.window_s),
          fmt::format("{:.2f} nT", worst.limit_nT), ""};
}

}  // namespace mgtd::daemon::run
