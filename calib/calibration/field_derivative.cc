// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/field_derivative.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace mgtd::calib::calibration {

Eigen::Matrix3d turn_axes(const sensor::SensorModel& sensor) {
  const Eigen::Matrix3d Az = sensor::rotation_z(sensor.gamma_rad),
                        AzAy = Az * sensor::rotation_y(sensor.beta_rad);
  Eigen::Matrix3d axes;
  axes << -AzAy.col(0), -Az.col(1), -Eigen::Vector3d::UnitZ();
  return axes;
}

FieldDerivative field_derivative(const sensor::SensorModel& m, const Eigen::Vector3d& b_P_nT) {
  FieldDerivative d;
  const Eigen::Matrix3d R = m.R_PS(), CA = m.response();
  const Eigen::Vector3d b_S = R.transpose() * b_P_nT;
  const Eigen::Matrix3d gain = R * CA.inverse();
  const double st = std::sin(m.theta_rad), ct = std::cos(m.theta_rad);
  const double sf = std::sin(m.phi_rad), cf = std::cos(m.phi_rad);
  const double sp = std::sin(m.psi_rad), cp = std::cos(m.psi_rad);
  const auto& c = m.scale;
  const Eigen::Vector3d along_scale = CA * b_S;
  d.col(sensor::theta) = -gain.col(0) * c[0] * (-st * cf * b_S[0] + ct * cf * b_S[1]);
  d.col(sensor::phi) = -gain.col(0) * c[0] * (-ct * sf * b_S[0] - st * sf * b_S[1] + cf * b_S[2]);
  d.col(sensor::psi) = -gain.col(1) * c[1] * (-sp * b_S[1] + cp * b_S[2]);
  for (int a = 0; a < 3; ++a) {
    d.col(sensor::cx + a) = -gain.col(a) * along_scale[a] / c[a];
    d.col(sensor::ix + a) = -gain.col(a);
  }
  const Eigen::Matrix3d axes = turn_axes(m);
  for (int a = 0; a < 3; ++a) d.col(sensor::alpha + a) = axes.col(a).cross(b_P_nT);
  return d;
}

}  // namespace mgtd::calib::calibration
