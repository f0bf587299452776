// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/run_memory.h"

#include <Eigen/QR>
#include <optional>

#include "calib/sensor/channels.h"
#include "calib/sensor/sensor_equations.h"
#include "calib/sensor/sensor_start.h"

namespace mgtd::calib::effects::laws {
namespace {

constexpr int kElements = 10;  // of the rotation, and a constant

Eigen::RowVectorXd elements(const TableAngles& a) {
  const Eigen::Matrix3d R = sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0);
  Eigen::RowVectorXd row(kElements);
  row << R.reshaped().transpose(), 1;
  return row;
}

/// Readings by the angles of the table; empty where too few poses have angles.
std::optional<Eigen::MatrixXd> readings_by_angles(const PoseTable& table) {
  std::vector<const Pose*> known;
  for (const Pose& pose : table.poses) {
    if (pose.angles()) known.push_back(&pose);
  }
  if (known.size() <= kElements) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(known.size());
  Eigen::MatrixXd A(n, kElements), y(n, 3 * static_cast<Eigen::Index>(table.poses.front().y_nT.size()));
  for (Eigen::Index k = 0; k < n; ++k) {
    const Pose& pose = *known[static_cast<std::size_t>(k)];
    A.row(k) = elements(*pose.angles());
    for (std::size_t i = 0; i < pose.y_nT.size(); ++i)
      y.row(k).segment<3>(3 * static_cast<Eigen::Index>(i)) = pose.y_nT[i];
  }
  return A.completeOrthogonalDecomposition().solve(y);
}

SensorReadings offsets_of(const PoseTable& table) {
  SensorReadings out(table.poses.front().y_nT.size());
  const auto n = static_cast<Eigen::Index>(table.poses.size());
  Eigen::VectorXd f(n);
  for (Eigen::Index k = 0; k < n; ++k)
    f[k] = table.poses[static_cast<std::size_t>(k)].f_nT.value_or(kReferenceField_nT);
  for (std::size_t i = 0; i < out.size(); ++i) {
    Eigen::Matrix3Xd y(3, n);
    for (Eigen::Index k = 0; k < n; ++k) y.col(k) = table.poses[static_cast<std::size_t>(k)].y_nT[i];
    const auto start = sensor::sensor_start(y, f);
    out[i] =
        start ? start->offset_nT : Eigen::Vector3d((y.rowwise().maxCoeff() + y.rowwise().minCoeff()) / 2);
  }
  return out;
}

SensorReadings less(const SensorReadings& y_nT, const SensorReadings& offset_nT) {
  SensorReadings out(y_nT.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = y_nT[i] - offset_nT[i];
  return out;
}

}  // namespace

Result<std::vector<RememberedPose>> run_memory(const EffectContext& context) {
  if (context.table == nullptr || context.table->poses.empty())
    return fail(ErrorCode::refused, "an effect with a memory needs the poses before each pose");
  const PoseTable& table = *context.table;
  const SensorReadings offset_nT = context.offset_nT ? *context.offset_nT : offsets_of(table);
  std::optional<Eigen::MatrixXd> by_angles;
  if (!table.path.empty()) by_angles = readings_by_angles(table);
  std::vector<RememberedPose> out;
  auto point = table.path.begin();
  for (const Pose& pose : table.poses) {
    RememberedPose remembered{
        .pose = pose.number, .v_nT = less(pose.y_nT, offset_nT), .on_the_way = {}, .way_s = {}};
    for (; by_angles && pose.t_s && point != table.path.end() && point->t_s < *pose.t_s; ++point) {
      const Eigen::RowVectorXd y = elements(point->angles) * *by_angles;
      SensorReadings readings(offset_nT.size());
      for (std::size_t i = 0; i < readings.size(); ++i)
        readings[i] = y.segment<3>(3 * static_cast<Eigen::Index>(i)).transpose();
      remembered.on_the_way.push_back(less(readings, offset_nT));
      remembered.way_s.push_back(point->t_s);
    }
    out.push_back(std::move(remembered));
  }
  return out;
}

}  // namespace mgtd::calib::effects::laws
