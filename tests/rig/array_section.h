// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tests/rig/section.h"

namespace mgtd::rig {

/// This reads where the sensors are, platform frame: [array] of a scenario. Empty: the cross.
[[nodiscard]] std::vector<Eigen::Vector3d> read_positions(Section& array);

}  // namespace mgtd::rig
