// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/rig/scenario.h"
#include "tests/rig/survey.h"

namespace mgtd::rig {

/// This makes the recording that a scenario describes, straight from the physics: row k is the sample at time
/// k/rate_hz of every sensor, with the scenario's noise. A scenario without a recording has no rows.
[[nodiscard]] Survey simulated_recording(Scenario scenario);

}  // namespace mgtd::rig
