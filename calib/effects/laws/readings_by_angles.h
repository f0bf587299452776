// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "proto/pose.h"

/// What the sensors read by the angles of the table, learnt from the dwells of a run:
///
///     y(angles) = L (R(angles), 1)
///
/// with L the linear map from the nine elements of the table's rotation and a constant to the readings of all
/// sensors. The table stands a little off its angles; by how much at each dwell the readings tell, and L is
/// fitted to the angles less that. Readings in nT, angles in radians.
///
/// Does not know of temperatures or of a field that changes: good to some nT.
namespace mgtd::calib::effects::laws {

class ReadingsByAngles {
 public:
  /// Empty where too few poses have angles.
  [[nodiscard]] static std::optional<ReadingsByAngles> of(const PoseTable& table);

  /// Three readings for each sensor.
  [[nodiscard]] Eigen::RowVectorXd at(const TableAngles& angles) const;
  /// By how much azimuth, pitch and roll were off those of pose `k` of the table, as the readings tell; none
  /// where it has no angles.
  [[nodiscard]] const std::optional<Eigen::Vector3d>& deviation_rad(std::size_t k) const {
    return deviation_rad_[k];
  }

 private:
  Eigen::MatrixXd map_;
  std::vector<std::optional<Eigen::Vector3d>> deviation_rad_;
};

/// `angles` off by `deviation_rad`.
[[nodiscard]] TableAngles deviating(TableAngles angles, const Eigen::Vector3d& deviation_rad);

}  // namespace mgtd::calib::effects::laws
