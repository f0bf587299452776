// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/rig/dropped_magnet.h"
#include "tests/rig/gross_reading.h"
#include "tests/rig/section.h"
#include "tests/rig/vehicle.h"

/// This reads what disturbs a run from a moment on or for a while: [[vehicle]], [[magnet]] and [[gross]] of a
/// scenario.
namespace mgtd::rig {

[[nodiscard]] Vehicle read_vehicle(Section& section);
/// It must lie outside an array with that reach about its centre.
[[nodiscard]] DroppedMagnet read_magnet(Section& section, double reach_m);
[[nodiscard]] GrossReading read_gross(Section& section);

}  // namespace mgtd::rig
