// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/readings_by_angles.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::effects::laws {
namespace {

constexpr int kElements = 10;  // of the rotation, and a constant
constexpr int kRounds = 4;
constexpr double kStep_rad = 1e-4;  // for the derivative by an angle
/// A turn that moves the readings by less than this for a tenth of a degree is not seen in them.
constexpr double kSeen_nT_per_rad = 1 / 1.7e-3;

Eigen::RowVectorXd elements(const TableAngles& a) {
  const Eigen::Matrix3d R = sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0);
  Eigen::RowVectorXd row(kElements);
  row << R.reshaped().transpose(), 1;
  return row;
}

/// The small turn about the table's axes that brings the map closer to the readings `y`.
Eigen::Vector3d turn_towards(const Eigen::RowVectorXd& y, const TableAngles& angles,
                             const Eigen::MatrixXd& map) {
  Eigen::MatrixX3d J(map.cols(), 3);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kStep_rad * Eigen::Vector3d::Unit(i);
    J.col(i) =
        ((elements(deviating(angles, step)) - elements(deviating(angles, -step))) * map / (2 * kStep_rad))
            .transpose();
  }
  Eigen::Matrix3d A = J.transpose() * J;
  A.diagonal().array() += kSeen_nT_per_rad * kSeen_nT_per_rad;
  return A.llt().solve(J.transpose() * (y - elements(angles) * map).transpose());
}

}  // namespace

TableAngles deviating(TableAngles angles, const Eigen::Vector3d& deviation_rad) {
  angles.azimuth_rad += deviation_rad[0];
  angles.pitch_rad += deviation_rad[1];
  angles.roll_rad += deviation_rad[2];
  return angles;
}

std::optional<ReadingsByAngles> ReadingsByAngles::of(const PoseTable& table) {
  ReadingsByAngles out;
  out.deviation_rad_.resize(table.poses.size());
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    if (!table.poses[k].angles()) continue;
    known.push_back(k);
    out.deviation_rad_[k] = Eigen::Vector3d::Zero();
  }
  if (known.size() <= kElements) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(known.size());
  Eigen::MatrixXd A(n, kElements), y(n, 3 * static_cast<Eigen::Index>(table.poses.front().y_nT.size()));
  for (Eigen::Index row = 0; row < n; ++row) {
    const Pose& pose = table.poses[known[static_cast<std::size_t>(row)]];
    for (std::size_t i = 0; i < pose.y_nT.size(); ++i)
      y.row(row).segment<3>(3 * static_cast<Eigen::Index>(i)) = pose.y_nT[i];
  }
  for (int round = 0; round < kRounds; ++round) {
    const auto at = [&](std::size_t k) {
      return deviating(*table.poses[k].angles(), *out.deviation_rad_[k]);
    };
    for (Eigen::Index row = 0; row < n; ++row)
      A.row(row) = elements(at(known[static_cast<std::size_t>(row)]));
    out.map_ = A.completeOrthogonalDecomposition().solve(y);
    for (Eigen::Index row = 0; row < n; ++row) {
      const std::size_t k = known[static_cast<std::size_t>(row)];
      *out.deviation_rad_[k] += turn_towards(y.row(row), at(k), out.map_);
    }
  }
  return out;
}

Eigen::RowVectorXd ReadingsByAngles::at(const TableAngles& angles) const { return elements(angles) * map_; }

}  // namespace mgtd::calib::effects::laws
