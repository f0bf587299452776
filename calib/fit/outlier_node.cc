// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/outlier_node.h"

#include <fmt/format.h>

namespace mgtd::calib::fit {

bool covers(const OutlierNode& node, int sensor, int axis) {
  if (node.where == "pose") return true;
  const std::string name = fmt::format("s{}", sensor + 1);
  return node.where == name || node.where == fmt::format("{}.{}", name, "xyz"[axis]);
}

}  // namespace mgtd::calib::fit
