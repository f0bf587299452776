// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "proto/pose.h"

namespace mgtd::rig {

/// A simulated run as the CSV pose table that users write, every column that has a value somewhere.
[[nodiscard]] std::string pose_table_csv(const PoseTable& table);

}  // namespace mgtd::rig
