// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "calib/effects/effect_context.h"
#include "calib/effects/laws/readings_by_angles.h"
#include "proto/error.h"

/// run_memory() reconstructs what the sensors saw before each pose of a run, for effects with a memory.
///
///     at a dwell        v = reading - offset
///     on the way        v = y(angles) - offset by readings_by_angles.h; only where the run kept the path of
///                       the table. Where a reading turns, the path is followed between its own points
///                       (table_path.h); how far the table stood off the angles says way_deviation.h
///
/// Offsets are those of the context, else of each sensor by itself (sensor_start.h): good to some nT, which
/// is 1e-4 of the field that a memory is about.
namespace mgtd::calib::effects::laws {

/// What Effect::missing says of a pose that is not in the run an effect is bound to.
inline constexpr std::string_view kNoMemory = "the readings before";

using SensorReadings = PerSensor<Eigen::Vector3d>;

struct RememberedWayPoint {
  double t_s{0};
  SensorReadings v_nT;
  TableAngles angles;                ///< where the table is taken to have been
  Eigen::Matrix3d angle_covariance;  ///< of that, over the square of the table's accuracy
};

struct RememberedPose {
  int pose{0};                                 ///< number
  SensorReadings v_nT;                         ///< at the dwell
  std::vector<RememberedWayPoint> on_the_way;  ///< since the dwell before, in order
};

struct RunMemory {
  std::vector<RememberedPose> poses;          ///< in the order of the run
  std::optional<ReadingsByAngles> by_angles;  ///< where the run kept the path

  /// By how much v at a point of the way may be off because nothing tells how far the table stood off its
  /// angles: one standard deviation for each radian of the table's accuracy.
  [[nodiscard]] SensorReadings sd_nT_per_rad(const RememberedWayPoint& point) const;
};

/// That of the context where it has one. Refuses a context without poses.
[[nodiscard]] Result<std::shared_ptr<const RunMemory>> run_memory(const EffectContext& context);

}  // namespace mgtd::calib::effects::laws
