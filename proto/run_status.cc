// SPDX-License-Identifier: Apache-2.0
#include "proto/run_status.h"

#include <array>

namespace mgtd {

std::string_view name(RunState state) {
  static constexpr std::array<std::string_view, 16> kNames{
      "idle",   "preflight", "homing",   "asking", "moving",   "settling", "dwelling", "suspended",
      "paused", "solving",   "aborting", "done",   "rejected", "aborted",  "failed",   "interrupted"};
  return kNames.at(static_cast<std::size_t>(state));
}

bool is_active(RunState state) {
  switch (state) {
    case RunState::preflight:
    case RunState::homing:
    case RunState::asking:
    case RunState::moving:
    case RunState::settling:
    case RunState::dwelling:
    case RunState::suspended:
    case RunState::paused:
    case RunState::solving:
    case RunState::aborting:
      return true;
    default:
      return false;
  }
}

}  // namespace mgtd
