// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/fit/outlier_node.h"

namespace mgtd::calib::report {

/// outlier_texts() writes one line for what is left out of one pose, or of consecutive poses at the same
/// place: "pose 17, s3.z: 300 nT off, 60 times what the other readings allow", "poses 41-45 disturbed: a
/// source that came and went, all sensors contradict the rest by 37 nT (rms)".
[[nodiscard]] std::vector<std::string> outlier_texts(const std::vector<fit::OutlierNode>& nodes);

}  // namespace mgtd::calib::report
