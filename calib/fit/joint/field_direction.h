// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/sensor/sensor_equations.h"
#include "proto/pose.h"

namespace mgtd::calib::fit::joint {

/// field_direction() gives the direction in the platform frame of a field that lies along +Z of the site, at
/// these angles of a table. That is what an attitude means where no table turned the array.
[[nodiscard]] inline Eigen::Vector3d field_direction(const TableAngles& a) {
  return sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0) * Eigen::Vector3d::UnitZ();
}

}  // namespace mgtd::calib::fit::joint
