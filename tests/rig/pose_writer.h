// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "tests/rig/scenario.h"

/// A pose table straight from the physics, without ports or daemon: dwell means of many noisy samples.
namespace mgtd::rig {

enum class PoseSet { run157, grid5832 };

/// run157: 36 level azimuths (out in 20 degree steps, back between them), then 121 random attitudes, 24 of
/// them revisits, dwells of 4 and 8 s. grid5832: 20 degree steps about Z, Y and X; the 18 level azimuths are
/// the standard set; one sample a pose, no table error. The table takes its real way between the poses.
[[nodiscard]] std::string pose_table_csv(const Scenario& scenario, PoseSet set);

}  // namespace mgtd::rig
