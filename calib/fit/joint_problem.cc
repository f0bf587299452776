// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint_problem.h"

#include <Eigen/Geometry>
#include <cmath>

namespace mgtd::calib {

int JointProblem::coefficients() const {
  std::size_t sum = 0;
  for (const EffectPtr& effect : effects) sum += effect->coefficients().size();
  return static_cast<int>(sum);
}

Eigen::VectorXd JointState::fixed() const {
  Eigen::VectorXd x(kEffectSlot + coefficients.size());
  for (std::size_t i = 0; i < kSensors; ++i) {
    x.segment<kSensorParameters>(static_cast<int>(i) * kSensorParameters) = sensors[i].parameters();
  }
  x.segment<2>(kSiteSlot).setZero();
  x[kFieldSlot] = f_nT;
  x.tail(coefficients.size()) = coefficients;
  return x;
}

JointState JointState::moved(const Eigen::VectorXd& step) const {
  JointState next = *this;
  for (std::size_t i = 0; i < kSensors; ++i) {
    const auto part = step.segment<kSensorParameters>(static_cast<int>(i) * kSensorParameters);
    next.sensors[i] = SensorModel::from_parameters(sensors[i].parameters() + part, sensors[i].mounting);
  }
  next.direction = (direction + tangents(direction) * step.segment<2>(kSiteSlot)).normalized();
  next.f_nT += step[kFieldSlot];
  next.coefficients += step.tail(coefficients.size());
  return next;
}

double inclination_of(const Eigen::Vector3d& n) { return std::atan2(n[2], std::hypot(n[0], n[1])); }
double declination_of(const Eigen::Vector3d& n) { return std::atan2(n[1], n[0]); }

Eigen::Vector3d direction_of(double inclination_rad, double declination_rad) {
  const double h = std::cos(inclination_rad);
  return {h * std::cos(declination_rad), h * std::sin(declination_rad), std::sin(inclination_rad)};
}

Eigen::Matrix2d inclination_declination_rows(const Eigen::Vector3d& n) {
  const double h = std::hypot(n[0], n[1]);
  Eigen::Matrix<double, 2, 3> rows;
  rows << -n[2] * n[0] / h, -n[2] * n[1] / h, h, -n[1] / (h * h), n[0] / (h * h), 0;
  return rows * tangents(n);
}

Eigen::Matrix<double, 3, 2> tangents(const Eigen::Vector3d& n) {
  Eigen::Index smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix<double, 3, 2> t;
  t.col(0) = n.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  t.col(1) = n.cross(t.col(0));
  return t;
}

}  // namespace mgtd::calib
