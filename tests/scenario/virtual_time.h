// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>

#include "proto/time.h"
#include "tests/rig/scenario.h"

/// What the virtual daemons share: the hour at which everything was switched on, the two clocks of their
/// host, and a scenario from its text.
namespace mgtd::test {

inline constexpr double kSwitchedOn_utc_s = 1'795'255'200;  // 2026-11-21T10:00:00Z

/// `t_s` after that; `wall_step_s`: by which the host's clock was set meanwhile.
[[nodiscard]] inline Stamp stamp_at(double t_s, double wall_step_s) {
  return {Instant{from_seconds(1000 + t_s)},
          WallTime{static_cast<std::int64_t>(kSwitchedOn_utc_s) * 1'000'000'000 +
                   from_seconds(t_s + wall_step_s).count()}};
}

[[nodiscard]] inline rig::Scenario scenario_of(const std::string& text) {
  auto scenario = rig::parse_scenario(text, "test");
  if (!scenario) throw std::invalid_argument(scenario.error().at(0));
  return *std::move(scenario);
}

}  // namespace mgtd::test
