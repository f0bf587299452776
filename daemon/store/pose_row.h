// SPDX-License-Identifier: Apache-2.0
#pragma once
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

/// `number`, `set`, `t_utc` and covariates are not among them.
[[nodiscard]] std::span<const PoseColumn> pose_columns();

}  // namespace mgtd::daemon::store
