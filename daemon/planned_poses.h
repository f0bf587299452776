// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "daemon/config.h"
#include "proto/error.h"
#include "proto/pose.h"

namespace mgtd::daemon {

/// The poses that a run of this configuration would measure, with their times, as a table without readings.
/// A configuration without a table stands for one that reaches every attitude.
[[nodiscard]] Result<PoseTable> planned_poses(const Config& config);

/// Those of the attitudes that this configuration's table can take.
[[nodiscard]] std::vector<TableAngles> reachable(const Config& config, std::vector<TableAngles> attitudes);

}  // namespace mgtd::daemon
