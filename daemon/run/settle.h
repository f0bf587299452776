// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "calib/sensor/channels.h"
#include "proto/epoch.h"
#include "proto/reading.h"
#include "proto/time.h"

/// Settle decides from the readings, not from a timer, when the field is steady after a move.
///
/// Over a sliding window of the epochs since the table stopped, per axis: least-squares slope s and scatter
/// sd about it. Settled when the table is on target and, on every axis, |s| x window is within slope_sigmas
/// of its own standard error or below `tolerance_nT`, and sd is below disturbed_ratio x the noise known from
/// the preflight. A trend that remains at max_s is `timed_out`; scatter that remains is `disturbed`:
/// something in the room moves.
///
/// The window is window_s, and longer where epochs come so slowly that it would hold too few for a slope.
namespace mgtd::daemon::run {

struct SettleConfig {
  double min_s{0.5};       ///< from stop; eddy currents and ringing of the table
  double max_s{20};        ///< from stop
  double move_max_s{120};  ///< from command to stop; beyond: timed_out
  double window_s{1};
  double rate_hz{50};
  double slope_sigmas{4};
  double tolerance_nT{0.5};   ///< a change over the window that never matters
  double disturbed_ratio{4};  ///< scatter against noise
  double noise_nT{0};         ///< of one sample, the largest axis; 0 unknown: scatter is not judged
};

constexpr std::size_t kFewestInWindow = 6;  ///< epochs that tell a slope and the scatter about it
[[nodiscard]] constexpr double whole_window_s(const SettleConfig& config) {
  return std::max(config.window_s, static_cast<double>(kFewestInWindow) / config.rate_hz);
}

enum class SettleState { settling, settled, disturbed, timed_out };

struct SettleOutcome {
  SettleState state{SettleState::settling};
  std::string measured;  ///< "s3.y drifts 14.2 nT over 1.0 s"
  std::string limit;     ///< "2.0 nT"
  std::string remedy;
};

class Settle {
 public:
  /// A move was commanded at `commanded`.
  Settle(SettleConfig config, Instant commanded);

  void add(const EpochOrGap& item);
  void add(const TableReading& reading);
  /// Answers of the past do not change: once settled, disturbed or timed out, it stays.
  [[nodiscard]] SettleOutcome judge(Instant now);
  /// When the table was first seen at rest on target.
  [[nodiscard]] std::optional<Instant> stopped() const { return stopped_; }

 private:
  using Sample = calib::sensor::FieldVector;
  struct WindowEntry {
    Instant t;
    Sample y_nT;
  };
  struct Worst {
    int drifting_axis{0}, noisy_axis{0};
    double change_nT{0}, limit_nT{0};  ///< of the drifting axis
    double drift_excess{0};            ///< change / limit
    double sd_nT{0};                   ///< of the noisy axis
  };
  [[nodiscard]] bool window_full() const;
  [[nodiscard]] Worst measure() const;
  [[nodiscard]] SettleOutcome judge_table(Instant now) const;
  [[nodiscard]] SettleOutcome judge_field(Instant now) const;

  SettleConfig config_;
  Instant commanded_;
  std::optional<Instant> stopped_;
  std::deque<WindowEntry> window_;
  std::optional<SettleOutcome> final_;
};

}  // namespace mgtd::daemon::run
