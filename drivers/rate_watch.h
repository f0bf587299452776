// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>

#include "drivers/deadline.h"
#include "proto/time.h"

/// A RateWatch tells whether a device sends as often as it was told to. It counts readings, those lost on the
/// way included, over kWindow_s of its time and kTicks ticks of the host: a host that listens late, or whose
/// clock runs fast against a simulated rig, blames nobody. Pure.
namespace mgtd::drivers {

class RateWatch {
 public:
  static constexpr double kWindow_s = 10;
  static constexpr int kTicks = 500;
  static constexpr double kTolerance = 0.1;  ///< relative; oscillators and lost lines stay far below

  void restart() {
    window_.clear();
    count_ = 0;
    first_.reset();
  }
  /// The reading is number `seq` of the device.
  void heard(std::uint64_t seq, Instant at) {
    if (!first_) {
      first_ = at;
      first_seq_ = seq;
      window_.set(at, kWindow_s, kTicks);
    }
    count_ = seq - first_seq_;
    last_ = at;
  }
  /// Once per tick. The rate that was found, where it is another than the wanted one.
  [[nodiscard]] std::optional<double> wrong_hz(double wanted_hz, Instant now) {
    if (!first_ || !window_.passed(now)) return std::nullopt;
    const double found_hz = static_cast<double>(count_) / to_seconds(last_ - *first_);
    restart();
    if (std::abs(found_hz / wanted_hz - 1) <= kTolerance) return std::nullopt;
    return found_hz;
  }

 private:
  Deadline window_;
  std::uint64_t count_{0}, first_seq_{0};
  std::optional<Instant> first_;
  Instant last_{};
};

}  // namespace mgtd::drivers
