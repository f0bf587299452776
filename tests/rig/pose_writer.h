// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "proto/pose.h"

namespace mgtd::rig {

/// This writes a simulated run as the CSV pose table that users write, with every column that has a value
/// somewhere.
[[nodiscard]] std::string pose_table_csv(const PoseTable& table);

}  // namespace mgtd::rig
