// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/time.h"

/// A Deadline is a time-out that blames the device only if the host has had the chance to listen.
///
/// It passes when the span is over *and* a number of ticks was seen since it was set: a host that was stopped
/// for a minute, or whose clock runs fifty times faster than real time against a simulated rig, first reads
/// what has come in before it declares a device silent.
namespace mgtd::drivers {

class Deadline {
 public:
  static constexpr int kFairTicks = 100;

  void set(Instant now, double span_s, int min_ticks = kFairTicks) {
    at_ = now + from_seconds(span_s);
    ticks_left_ = min_ticks;
    armed_ = true;
  }
  void clear() { armed_ = false; }
  [[nodiscard]] bool armed() const { return armed_; }

  /// To be asked exactly once per tick.
  [[nodiscard]] bool passed(Instant now) {
    if (!armed_) return false;
    if (ticks_left_ > 0) --ticks_left_;
    return ticks_left_ == 0 && now >= at_;
  }

 private:
  Instant at_{};
  int ticks_left_{0};
  bool armed_{false};
};

}  // namespace mgtd::drivers
