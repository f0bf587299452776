// SPDX-License-Identifier: Apache-2.0
#include "calib/sensor/sensor_model.h"

#include <Eigen/LU>

#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::sensor {

Eigen::Matrix3d rotation_x(double alpha_rad) { return turn_x(alpha_rad); }
Eigen::Matrix3d rotation_y(double beta_rad) { return turn_y(beta_rad); }
Eigen::Matrix3d rotation_z(double gamma_rad) { return turn_z(gamma_rad); }

Eigen::Matrix3d SensorModel::response() const { return response_matrix(theta_rad, phi_rad, psi_rad, scale); }

Eigen::Matrix3d SensorModel::R_PS() const {
  return rotation_z(gamma_rad) * rotation_y(beta_rad) * rotation_x(alpha_rad) * mounting;
}

Eigen::Vector3d SensorModel::predict(const Eigen::Vector3d& b_P_nT) const {
  return response() * (R_PS().transpose() * b_P_nT) + offset_nT;
}

Eigen::Vector3d SensorModel::correct(const Eigen::Vector3d& y_nT) const {
  return R_PS() * response().triangularView<Eigen::Upper>().solve(y_nT - offset_nT);
}

ParameterVector SensorModel::parameters() const {
  ParameterVector p;
  p << theta_rad, phi_rad, psi_rad, scale, offset_nT, alpha_rad, beta_rad, gamma_rad;
  return p;
}

SensorModel SensorModel::from_parameters(const ParameterVector& p, const Eigen::Matrix3d& mounting) {
  return {.theta_rad = p[theta],
          .phi_rad = p[phi],
          .psi_rad = p[psi],
          .scale = p.segment<3>(cx),
          .offset_nT = p.segment<3>(ix),
          .alpha_rad = p[alpha],
          .beta_rad = p[beta],
          .gamma_rad = p[gamma],
          .mounting = mounting};
}

}  // namespace mgtd::calib::sensor
