// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/error.h"
#include "proto/pose.h"

/// Two runs of one rig as one pose table: what a second measurement was made for, it tells beside the first.
///
/// Times become seconds since the start of the earlier run, pose numbers of the later one go on behind those
/// of the earlier; everything else stays. Which is earlier tells t_utc. Without it in either run the second
/// must go on in t_s where the first ends, or neither has any time: then they stand in the order given.
///
/// What it takes for granted and cannot see: the same array, mounted in the same way on a table that kept its
/// zero, at the same place. Where that is not so the fit of both is worse than that of each. Between the runs
/// the way of the table is not known: a memory of the cores is followed as if it had gone straight on.
namespace mgtd::calib {

/// Refuses runs that overlap in time, and those of which only one tells it.
[[nodiscard]] Result<PoseTable> joined(const PoseTable& a, const PoseTable& b);

}  // namespace mgtd::calib
