// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_problem.h"

#include <Eigen/Geometry>
#include <cmath>

#include "calib/fit/orientation.h"
#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::fit::joint {

int JointProblem::coefficients() const {
  std::size_t sum = 0;
  for (const effects::EffectPtr& effect : effects) sum += effect->coefficients().size();
  return static_cast<int>(sum);
}

std::vector<int> JointProblem::idle_slots() const {
  const FixedSlots at = slots();
  std::vector<int> out;
  if (!has_angles) out = {at.site(), at.site() + 1};
  if (!common_field && !site_reference()) out.push_back(at.field());
  return out;
}

int JointProblem::site_unknowns() const {
  return (common_field ? 1 : 0) + (has_angles ? 2 : 0) + (site_reference() ? 1 : 0);
}

Eigen::VectorXd JointState::fixed() const {
  const FixedSlots at = slots();
  Eigen::VectorXd x(at.effects() + coefficients.size());
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    x.segment<sensor::kSensorParameters>(static_cast<int>(i) * sensor::kSensorParameters) =
        sensors[i].parameters();
  }
  x.segment<2>(at.site()).setZero();
  x[at.field()] = R_SR ? 0 : f_nT;
  x.tail(coefficients.size()) = coefficients;
  return x;
}

namespace {

/// The sensor's angles after a step, to first order the sum. The step is taken on the rotation group, so that
/// a turn common to all sensors stays one however long it is: poses whose attitude is weakly known follow it
/// at no cost.
void turn(const sensor::SensorModel& from, const Eigen::Vector3d& step, sensor::SensorModel& to) {
  const Eigen::Matrix3d z = sensor::rotation_z(from.gamma_rad), zy = z * sensor::rotation_y(from.beta_rad);
  const sensor::Vector3<double> w =
      step[2] * Eigen::Vector3d::UnitZ() + step[1] * z.col(1) + step[0] * zy.col(0);
  const Eigen::Vector3d angles =
      angles_of(sensor::turn_by<double>(w) * zy * sensor::rotation_x(from.alpha_rad));
  to.alpha_rad = angles[0], to.beta_rad = angles[1], to.gamma_rad = angles[2];
}

}  // namespace

JointState JointState::moved(const Eigen::VectorXd& step) const {
  JointState next = *this;
  const FixedSlots at = slots();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const auto part =
        step.segment<sensor::kSensorParameters>(static_cast<int>(i) * sensor::kSensorParameters);
    next.sensors[i] =
        sensor::SensorModel::from_parameters(sensors[i].parameters() + part, sensors[i].mounting);
    turn(sensors[i], part.tail<3>(), next.sensors[i]);
  }
  if (R_SR) {
    const Eigen::Vector3d w = reference_turns(direction) * step.segment<3>(at.site());
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(w.norm(), w.stableNormalized()).toRotationMatrix();
    next.R_SR = turn * *R_SR;
    next.direction = (turn * direction).normalized();
  } else {
    next.direction = (direction + tangents(direction) * step.segment<2>(at.site())).normalized();
    next.f_nT += step[at.field()];
  }
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

Eigen::Matrix3d reference_turns(const Eigen::Vector3d& n) {
  const Eigen::Matrix<double, 3, 2> t = tangents(n);
  Eigen::Matrix3d out;
  out << n.cross(t.col(0)), n.cross(t.col(1)), n;
  return out;
}

}  // namespace mgtd::calib::fit::joint
