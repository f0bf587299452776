// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "calib/effects/effect_context.h"
#include "proto/error.h"

/// Reconstructs what the sensors saw before each pose of a run, for effects with a memory.
///
///     at a dwell        v = reading - offset
///     on the way        v = y(angles) - offset by readings_by_angles.h; only where the run kept the path of
///                       the table. Where a reading turns, the path is followed between its own points
///                       (table_path.h), and the angles pass from how far the table stood off them at the
///                       dwell before to how far it stands off them at the pose
///
/// Offsets are those of the context, else of each sensor by itself (sensor_start.h): good to some nT, which
/// is 1e-4 of the field that a memory is about.
namespace mgtd::calib::effects::laws {

/// What Effect::missing says of a pose that is not in the run an effect is bound to.
inline constexpr std::string_view kNoMemory = "the readings before";

using SensorReadings = PerSensor<Eigen::Vector3d>;

struct RememberedPose {
  int pose{0};                             ///< number
  SensorReadings v_nT;                     ///< at the dwell
  std::vector<SensorReadings> on_the_way;  ///< since the dwell before, in order
  std::vector<double> way_s;               ///< their times
};

/// In the order of the run. Refuses a context without poses.
[[nodiscard]] Result<std::vector<RememberedPose>> run_memory(const EffectContext& context);

}  // namespace mgtd::calib::effects::laws
