// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "proto/error.h"

/// All rooms use these types of time. Pure code never reads a clock: an `Instant` comes in as an argument.
namespace mgtd {

/// Monotonic time of the host. Its zero means nothing; only differences do.
using Instant = std::chrono::time_point<std::chrono::steady_clock, std::chrono::nanoseconds>;
using Duration = std::chrono::nanoseconds;

[[nodiscard]] constexpr double to_seconds(Duration d) { return static_cast<double>(d.count()) * 1e-9; }
[[nodiscard]] constexpr Duration from_seconds(double s) {
  return Duration{static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5))};
}

/// UTC as nanoseconds since 1970-01-01T00:00:00Z, leap seconds not counted (POSIX).
struct WallTime {
  std::int64_t ns{0};
  auto operator<=>(const WallTime&) const = default;
};

/// The two clocks read together, at the edge, when bytes arrived.
struct Stamp {
  Instant mono{};
  WallTime wall{};
};

/// "2026-11-21T10:00:00.123456Z": microseconds, always six digits, always Z.
[[nodiscard]] std::string format_utc(WallTime t);

/// Accepts the form above with 0 to 9 fractional digits, in the years 1678 to 2261, which nanoseconds in 64
/// bits reach. Anything else, a time zone offset included, is refused.
[[nodiscard]] Result<WallTime> parse_utc(std::string_view text);

}  // namespace mgtd
