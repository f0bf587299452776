// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "proto/pose.h"
#include "tests/rig/survey.h"

namespace mgtd::rig {

/// This writes a simulated run as the CSV pose table that users write, with every column that the kind of
/// survey has. A recording has no set, no means and no standard deviations of samples.
[[nodiscard]] std::string pose_table_csv(const Survey& survey);
[[nodiscard]] std::string pose_table_csv(const PoseTable& table);

}  // namespace mgtd::rig
