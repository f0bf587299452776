// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/run_memory.h"

#include <algorithm>
#include <optional>
#include <span>

#include "calib/effects/laws/readings_by_angles.h"
#include "calib/effects/laws/way_deviation.h"
#include "calib/poses/table_path.h"
#include "calib/sensor/channels.h"
#include "calib/sensor/sensor_start.h"

namespace mgtd::calib::effects::laws {
namespace {

constexpr int kParts = 4;  // of the time between two readings of the table, where a field turns

/// The way with points between the readings of the table before and after each at which a sensor's reading
/// turns: there the field may have gone further than at any of them.
std::vector<PathPoint> with_turns(std::span<const PathPoint> way, const ReadingsByAngles& by_angles) {
  std::vector<bool> turns(way.size() + 1);  // between k - 1 and k
  Eigen::RowVectorXd y, before;
  Eigen::ArrayXd step, step_before;
  for (std::size_t k = 0; k < way.size(); ++k) {
    y = by_angles.at(way[k].angles);
    if (k > 0) step = (y - before).transpose();
    if (k > 1 && (step * step_before < 0).any()) turns[k - 1] = turns[k] = true;
    before = y, step_before = step;
  }
  const poses::TablePath path(way);
  std::vector<PathPoint> out;
  for (std::size_t k = 0; k < way.size(); ++k) {
    for (int i = 1; turns[k] && i < kParts; ++i) {
      const double t_s = way[k - 1].t_s + (way[k].t_s - way[k - 1].t_s) * i / kParts;
      if (const auto angles = path.at(t_s)) out.push_back({t_s, *angles});
    }
    out.push_back(way[k]);
  }
  return out;
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

SensorReadings by_sensor(const Eigen::RowVectorXd& y) {
  SensorReadings out(static_cast<std::size_t>(y.size() / 3));
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = y.segment<3>(3 * static_cast<Eigen::Index>(i)).transpose();
  return out;
}

SensorReadings less(const SensorReadings& y_nT, const SensorReadings& offset_nT) {
  SensorReadings out(y_nT.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = y_nT[i] - offset_nT[i];
  return out;
}

RememberedWayPoint way_point(const PathPoint& at, const AngleDeviation& deviation,
                             const ReadingsByAngles& by_angles, const SensorReadings& offset_nT) {
  const TableAngles angles = deviating(at.angles, deviation.mean_rad);
  return {.t_s = at.t_s,
          .v_nT = less(by_sensor(by_angles.at(angles)), offset_nT),
          .angles = angles,
          .angle_covariance = deviation.covariance};
}

}  // namespace

SensorReadings RunMemory::sd_nT_per_rad(const RememberedWayPoint& point) const {
  const Eigen::Matrix3Xd J = by_angles->derivative(point.angles);
  const Eigen::RowVectorXd variance = J.cwiseProduct(point.angle_covariance * J).colwise().sum();
  return by_sensor(variance.cwiseSqrt());
}

Result<std::shared_ptr<const RunMemory>> run_memory(const EffectContext& context) {
  if (context.memory) return context.memory;
  if (context.table == nullptr || context.table->poses.empty())
    return fail(ErrorCode::refused, "an effect with a memory needs the poses before each pose");
  const PoseTable& table = *context.table;
  const SensorReadings offset_nT = context.offset_nT ? *context.offset_nT : offsets_of(table);
  RunMemory out;
  if (!table.path.empty()) out.by_angles = ReadingsByAngles::of(table);
  auto point = table.path.begin();
  AngleDeviation before;
  out.poses.reserve(table.poses.size());
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    const Pose& pose = table.poses[k];
    RememberedPose remembered{.pose = pose.number, .v_nT = less(pose.y_nT, offset_nT), .on_the_way = {}};
    if (out.by_angles && pose.t_s) {
      const ReadingsByAngles& by_angles = *out.by_angles;
      const auto begin = point;
      point = std::find_if(begin, table.path.end(), [&](const PathPoint& p) { return !(p.t_s < *pose.t_s); });
      const std::vector<PathPoint> way = with_turns({begin, point}, by_angles);
      const AngleDeviation after = by_angles.deviation(k).value_or(AngleDeviation());
      const std::vector<AngleDeviation> deviations = way_deviations(way, before, after);
      for (std::size_t i = 0; i < way.size(); ++i)
        remembered.on_the_way.push_back(way_point(way[i], deviations[i], by_angles, offset_nT));
      before = after;
    }
    out.poses.push_back(std::move(remembered));
  }
  return std::make_shared<const RunMemory>(std::move(out));
}

}  // namespace mgtd::calib::effects::laws
