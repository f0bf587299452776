// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "proto/pose.h"

/// A PoseList holds poses that are still to be measured, with the line of each in its file for error
/// messages.
namespace mgtd::calib::poses {

struct PoseList {
  PoseTable table;
  std::vector<int> lines;          ///< beside table.poses, from 1
  std::vector<std::string> notes;  ///< beside table.poses: column `note`, what a hand has to do before each
};

/// As parse_pose_list (pose_table.h).
[[nodiscard]] Result<PoseList> read_pose_list(std::string_view text, std::string_view file);

}  // namespace mgtd::calib::poses
