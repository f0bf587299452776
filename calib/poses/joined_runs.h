// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/error.h"
#include "proto/pose.h"

/// joined() joins two runs of one rig into one pose table, so that a second measurement is judged together
/// with the first.
///
/// Times become seconds since the start of the earlier run; pose numbers of the later run continue those of
/// the earlier; everything else stays. t_utc decides which run is earlier. Without it in either run, t_s of
/// the second must continue that of the first, or neither has any time: then they stay in the order given.
///
/// Assumed, and not checked: the same array, mounted in the same way on a table that kept its zero, at the
/// same place. Where that is not so, the fit of both has a larger residual than that of each. The path of the
/// table between the runs is not known: hysteresis is followed as if the table had gone straight on.
namespace mgtd::calib::poses {

/// Refuses arrays with unlike numbers of sensors, runs that overlap in time, and a pair of which only one
/// records time.
[[nodiscard]] Result<PoseTable> joined(const PoseTable& a, const PoseTable& b);

}  // namespace mgtd::calib::poses
