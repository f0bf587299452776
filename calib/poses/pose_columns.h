// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "proto/pose.h"

/// A PoseColumn is a numeric column of a pose table that has a meaning of its own, with the functions that
/// write it to a Pose and read it from one.
namespace mgtd::calib::poses {

struct PoseColumn {
  std::string name;
  bool required{false};
  std::function<void(Pose&, double)> set;
  std::function<std::optional<double>(const Pose&)> get;
  bool whole{false};  ///< only whole numbers within +-1e9
  /// Of the number as it stands in the file.
  struct Limits {
    double low{-std::numeric_limits<double>::infinity()}, high{std::numeric_limits<double>::infinity()};
    bool without_low{false};  ///< low itself is outside
    bool only_ends{false};    ///< low and high, nothing between
    [[nodiscard]] bool hold(double value) const;
    [[nodiscard]] std::string words() const;
  } limits{};
};

/// Those of an array of 0 to kMostSensors sensors, in the order they are written. `pose`, `set` and `t_utc`
/// are not numbers of this kind and stand before them. Made once; references stay valid.
[[nodiscard]] const std::vector<PoseColumn>& pose_columns(std::size_t sensors);

/// Of f_nT where the field is given as a vector beside it: a coil cage can make it nearly zero.
[[nodiscard]] PoseColumn::Limits field_limits_beside_reference();

/// A pose of an array of so many sensors at which nothing was measured.
[[nodiscard]] Pose unmeasured_pose(std::size_t sensors);

/// How many sensors the array of a table has; those of the cross where it has no pose.
[[nodiscard]] std::size_t sensors_of(const PoseTable& table);

/// "1 sensor", "8 sensors": for messages.
[[nodiscard]] std::string counted(std::size_t sensors);

}  // namespace mgtd::calib::poses
