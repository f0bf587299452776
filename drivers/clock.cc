// SPDX-License-Identifier: Apache-2.0
#include "drivers/clock.h"

namespace mgtd::drivers {
namespace {

WallTime wall_now() {
  return {std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()).count()};
}

}  // namespace

Clock::Clock(double speed_up)
    : speed_up_(speed_up), start_mono_(std::chrono::steady_clock::now()), start_wall_(wall_now()) {}

Stamp Clock::now() const {
  const Instant host_now = std::chrono::steady_clock::now();
  if (speed_up_ == 1.0) return {host_now, wall_now()};
  const Duration elapsed = from_seconds(to_seconds(host_now - start_mono_) * speed_up_);
  return {start_mono_ + elapsed, WallTime{start_wall_.ns + elapsed.count()}};
}

Duration Clock::host(Duration span) const { return from_seconds(to_seconds(span) / speed_up_); }

}  // namespace mgtd::drivers
