// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "proto/pose.h"

/// ReadingsByAngles predicts the readings of the sensors from the angles of the table, as learnt from the
/// dwells of a run:
///
///     y(angles) = L (R(angles), 1)
///
/// with L the linear map from the nine elements of the table's rotation and a constant to the readings of all
/// sensors. The table stands a little off its angles; by how much at each dwell the readings tell, and L is
/// fitted to the angles less that. A turn about the field itself they do not tell. Readings in nT, angles in
/// radians.
///
/// Does not know of temperatures or of a field that changes: good to some nT.
namespace mgtd::calib::effects::laws {

/// How far the table stands off its angles.
struct AngleDeviation {
  Eigen::Vector3d mean_rad{Eigen::Vector3d::Zero()};        ///< of azimuth, pitch and roll
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Identity()};  ///< over the square of the table's accuracy
};

class ReadingsByAngles {
 public:
  /// Empty where too few poses have angles.
  [[nodiscard]] static std::optional<ReadingsByAngles> of(const PoseTable& table);

  /// Three readings for each sensor.
  [[nodiscard]] Eigen::RowVectorXd at(const TableAngles& angles) const;
  /// Their derivatives by azimuth, pitch and roll, rows; nT/rad.
  [[nodiscard]] Eigen::Matrix3Xd derivative(const TableAngles& angles) const;
  /// At pose `k` of the table, as the readings tell; none where it has no angles.
  [[nodiscard]] const std::optional<AngleDeviation>& deviation(std::size_t k) const { return deviation_[k]; }

 private:
  Eigen::MatrixXd map_;
  std::vector<std::optional<AngleDeviation>> deviation_;
};

/// `angles` off by `deviation_rad`.
[[nodiscard]] TableAngles deviating(TableAngles angles, const Eigen::Vector3d& deviation_rad);

}  // namespace mgtd::calib::effects::laws
