// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/design/experiment_design.h"
#include "daemon/config/config.h"
#include "daemon/plan/run_plan.h"
#include "proto/error.h"
#include "proto/pose.h"

namespace mgtd::daemon::run {

/// planned_poses() lists the poses that a run of this configuration would measure, with their times, as a
/// table without readings.
[[nodiscard]] Result<PoseTable> planned_poses(const config::Config& config);

/// The same for a run with these options on a table with these limits.
[[nodiscard]] Result<PoseTable> planned_poses(const plan::PlanOptions& options,
                                              const drivers::TableLimits& limits);

/// How the runs of this configuration are planned, and on what table.
[[nodiscard]] plan::PlanOptions plan_options(const config::Config& config);
/// A configuration without a table stands for one that reaches every attitude.
[[nodiscard]] drivers::TableLimits table_limits(const config::Config& config);

/// Takes over what the configuration says of rig and site; the poses are left alone.
void assume(const config::Config& config, calib::design::DesignRequest& request);

/// Those of the attitudes that this configuration's table can take.
[[nodiscard]] std::vector<TableAngles> reachable(const config::Config& config,
                                                 std::vector<TableAngles> attitudes);

}  // namespace mgtd::daemon::run
