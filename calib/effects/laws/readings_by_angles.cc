// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/readings_by_angles.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::effects::laws {
namespace {

constexpr int kElements = 10;  // of the rotation, and a constant
constexpr int kRounds = 4;
constexpr double kStep_rad = 1e-4;  // for the derivative by an angle
/// A turn that moves the readings by less than this for a tenth of a degree is not seen in them.
constexpr double kSeen_nT_per_rad = 1 / 1.7e-3;

using Elements = Eigen::Matrix<double, 1, kElements>;

Elements elements(const TableAngles& a) {
  const Eigen::Matrix3d R =
      sensor::turn_z(a.azimuth_rad) * sensor::turn_y(a.pitch_rad) * sensor::turn_x(a.roll_rad);
  Elements row;
  row << R.reshaped().transpose(), 1;
  return row;
}

/// Of `map` by each angle, rows.
Eigen::Matrix3Xd derivative_of(const Eigen::MatrixXd& map, const TableAngles& angles) {
  Eigen::Matrix3Xd out(3, map.cols());
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kStep_rad * Eigen::Vector3d::Unit(i);
    out.row(i) =
        (elements(deviating(angles, step)) - elements(deviating(angles, -step))) * map / (2 * kStep_rad);
  }
  return out;
}

/// Moves `deviation` towards what brings the map closest to the readings `y`, and is small.
void turn_towards(const Eigen::RowVectorXd& y, const TableAngles& recorded, const Eigen::MatrixXd& map,
                  AngleDeviation& deviation) {
  constexpr double kSquare = kSeen_nT_per_rad * kSeen_nT_per_rad;
  const TableAngles angles = deviating(recorded, deviation.mean_rad);
  const Eigen::Matrix3Xd J = derivative_of(map, angles);
  const Eigen::Matrix3d A = J * J.transpose() + kSquare * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d pull = J * (y - elements(angles) * map).transpose() - kSquare * deviation.mean_rad;
  deviation.covariance = kSquare * A.inverse();
  deviation.mean_rad += deviation.covariance * pull / kSquare;
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
  out.deviation_.resize(table.poses.size());
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    if (!table.poses[k].angles()) continue;
    known.push_back(k);
    out.deviation_[k].emplace();
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
    for (Eigen::Index row = 0; row < n; ++row) {
      const std::size_t k = known[static_cast<std::size_t>(row)];
      A.row(row) = elements(deviating(*table.poses[k].angles(), out.deviation_[k]->mean_rad));
    }
    out.map_ = A.completeOrthogonalDecomposition().solve(y);
    for (Eigen::Index row = 0; row < n; ++row) {
      const std::size_t k = known[static_cast<std::size_t>(row)];
      turn_towards(y.row(row), *table.poses[k].angles(), out.map_, *out.deviation_[k]);
    }
  }
  return out;
}

Eigen::RowVectorXd ReadingsByAngles::at(const TableAngles& angles) const { return elements(angles) * map_; }

Eigen::Matrix3Xd ReadingsByAngles::derivative(const TableAngles& angles) const {
  return derivative_of(map_, angles);
}

}  // namespace mgtd::calib::effects::laws
