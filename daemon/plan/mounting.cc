// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/mounting.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "calib/sensor/sensor_equations.h"

namespace mgtd::daemon::plan {
namespace {

Eigen::Matrix3d rotation(const TableAngles& a) {
  return calib::sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0);
}

}  // namespace

/// R = Rz(a) Ry(p) Rx(r), passive: the first column is (ca cp, -sa cp, sp), the last row (sp, -cp sr, cp cr).
TableAngles platform_angles(const TableAngles& mounting, const TableAngles& table) {
  constexpr double kLocked = 1e-6;
  const Eigen::Matrix3d R = rotation(mounting) * rotation(table);
  TableAngles out;
  out.pitch_rad = std::asin(std::clamp(R(2, 0), -1.0, 1.0));
  if (std::hypot(R(0, 0), R(1, 0)) < kLocked) {
    out.azimuth_rad = std::atan2(R(0, 1), R(1, 1));
    return out;
  }
  out.azimuth_rad = std::atan2(-R(1, 0), R(0, 0));
  out.roll_rad = std::atan2(-R(2, 1), R(2, 2));
  return out;
}

}  // namespace mgtd::daemon::plan
