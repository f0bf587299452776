// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "calib/poses/pose_columns.h"

/// The run file stores a pose in the numeric columns of the pose table; its angles stand in rad,
/// `azimuth_rad` for `azimuth_deg`, so that they come back to the last bit.
namespace mgtd::daemon::store {

/// Of an array of 0 to kMostSensors sensors, those of a pose before those of its sensors. The reference field
/// is not among them. Made once; references stay valid.
[[nodiscard]] const std::vector<calib::poses::PoseColumn>& stored_columns(std::size_t sensors);

}  // namespace mgtd::daemon::store
