// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "proto/pose.h"

/// The run file stores a pose in numeric columns, named as in the pose table, with angles in rad.
namespace mgtd::daemon::store {

struct PoseColumn {
  std::string name;
  std::optional<double> (*get)(const Pose&, int index){nullptr};
  void (*set)(Pose&, int index, double value){nullptr};
  int index{0};  ///< which of a family (sensor and axis)
  bool required{false};
};

/// Of an array of 0 to kMostSensors sensors. `number`, `set`, `t_utc`, covariates and the reference field are
/// not among them.
[[nodiscard]] std::span<const PoseColumn> pose_columns(std::size_t sensors);

}  // namespace mgtd::daemon::store
