// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tests/rig/section.h"

namespace mgtd::rig {

/// read_positions() reads where the sensors are, in the platform frame, from [array] of a scenario; no
/// positions mean the cross.
[[nodiscard]] std::vector<Eigen::Vector3d> read_positions(Section& array);

}  // namespace mgtd::rig
