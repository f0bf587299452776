// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

/// The rig has its own rotation matrices; they are passive: they give the components of a fixed vector after
/// the frame is turned.
namespace mgtd::rig {

inline constexpr double kDeg = std::numbers::pi / 180.0;

inline Eigen::Matrix3d about_x(double angle_deg) {
  const double c = std::cos(angle_deg * kDeg), s = std::sin(angle_deg * kDeg);
  return Eigen::Matrix3d{{1, 0, 0}, {0, c, s}, {0, -s, c}};
}
inline Eigen::Matrix3d about_y(double angle_deg) {
  const double c = std::cos(angle_deg * kDeg), s = std::sin(angle_deg * kDeg);
  return Eigen::Matrix3d{{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
}
inline Eigen::Matrix3d about_z(double angle_deg) {
  const double c = std::cos(angle_deg * kDeg), s = std::sin(angle_deg * kDeg);
  return Eigen::Matrix3d{{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

/// The components of a fixed vector after the frame is turned by the rotation vector omega, exactly.
inline Eigen::Matrix3d turned_by(const Eigen::Vector3d& omega_rad) {
  const double angle = omega_rad.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(-angle, omega_rad / angle).toRotationMatrix();
}

}  // namespace mgtd::rig
