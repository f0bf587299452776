// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/poses/pose_list.h"
#include "daemon/plan/run_plan.h"
#include "proto/run_request.h"

namespace mgtd::daemon::plan {

/// requested_poses() turns a list of poses into the request for them that a client sends to the daemon.
[[nodiscard]] std::vector<RequestedPose> requested_poses(const calib::poses::PoseList& list);

/// A plan of the poses that a list names, in its order: what `mgt next -o` and `mgt plan` speak of becomes a
/// run. A dwell that the list leaves out is `options.dwell_short_s`; an angle may be given by whole turns
/// beside the table's travel.
///
/// Refuses, with file, line and column: a pose outside the table's limits, a number twice; a list for a table
/// on which the array is mounted by hand, since a list says nothing of that.
[[nodiscard]] Result<RunPlan> plan_from_list(const RunRequest& request, const PlanOptions& options,
                                             const drivers::TableLimits& limits);

}  // namespace mgtd::daemon::plan
