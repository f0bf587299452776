// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <string_view>

#include "proto/error.h"
#include "proto/pose.h"

/// These functions read numbers of poses as an operator writes them, "3", "3,7-9", and leave such poses out.
/// Spaces do not count.
namespace mgtd::daemon::store {

/// Refuses what is no list of numbers, a range that goes backwards, and more than a hundred thousand of them.
[[nodiscard]] Result<std::set<int>> parse_pose_numbers(std::string_view text);

/// The table without these poses. Refuses a number that no pose has.
[[nodiscard]] Result<PoseTable> without_poses(PoseTable table, const std::set<int>& numbers);

}  // namespace mgtd::daemon::store
