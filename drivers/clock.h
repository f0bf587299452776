// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/time.h"

/// A Clock reads the clocks of the host, and is the only place that does. With a speed-up, time runs that
/// much faster than the host's, for runs against a simulated rig that was started with the same factor: a
/// ten-second dwell then takes 10 s / speed_up of the operator's time and everything downstream, dwell
/// lengths, rates and stream times, stays as on a real rig.
namespace mgtd::drivers {

class Clock {
 public:
  explicit Clock(double speed_up = 1.0);
  [[nodiscard]] Stamp now() const;
  /// Host time that a span of this clock takes: for timers.
  [[nodiscard]] Duration host(Duration span) const;
  [[nodiscard]] double speed_up() const { return speed_up_; }

 private:
  double speed_up_;
  Instant start_mono_;
  WallTime start_wall_;
};

}  // namespace mgtd::drivers
