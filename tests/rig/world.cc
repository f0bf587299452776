// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/world.h"

#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

AxisMotion make_axis(const Scenario& s) {
  return {s.table_velocity_deg_per_s, s.table_acceleration_deg_per_s2, s.table_accuracy_deg};
}

}  // namespace

World::World(Scenario scenario)
    : scenario_(std::move(scenario)),
      axes_{make_axis(scenario_), make_axis(scenario_), make_axis(scenario_)},
      random_(scenario_.seed) {
  const double h = scenario_.baseline_m / 2;
  position_m_ = {Eigen::Vector3d{h, 0, 0}, Eigen::Vector3d{0, h, 0}, Eigen::Vector3d{-h, 0, 0},
                 Eigen::Vector3d{0, -h, 0}};
  for (std::size_t i = 0; i < 4; ++i) matrix_.at(i) = scenario_.truth.at(i).matrix();
  const double inclination = scenario_.inclination_deg * kDeg, declination = scenario_.declination_deg * kDeg;
  direction_ = {std::cos(inclination) * std::cos(declination), std::cos(inclination) * std::sin(declination),
                std::sin(inclination)};
}

Eigen::Matrix3d World::attitude(double t_s) const {
  return about_z(axes_[azimuth].true_deg(t_s)) * about_y(axes_[pitch].true_deg(t_s)) *
         about_x(axes_[roll].true_deg(t_s));
}

Eigen::Vector3d World::site_field(double t_s, const Eigen::Vector3d& x_m) const {
  Eigen::Vector3d B = (scenario_.f_nT + scenario_.field_drift_nT_per_h * t_s / 3600) * direction_;
  for (const auto& effect : scenario_.effects) B += effect->site_nT(t_s, x_m);
  return B;
}

double World::noise() {
  if (scenario_.noise_nT == 0) return 0;
  return scenario_.noise_nT * (scenario_.noise == NoiseKind::gaussian ? normal_(random_) : uniform_(random_));
}

Eigen::Vector3d World::read_sensor(int i, double t_s) {
  const auto at = static_cast<std::size_t>(i);
  const Eigen::Matrix3d T = attitude(t_s);
  const Eigen::Vector3d v = matrix_.at(at) * (T * site_field(t_s, T.transpose() * position_m_.at(at)));
  Eigen::Vector3d y = v + scenario_.truth.at(at).offset_nT;
  for (int a = 0; a < 3; ++a) {
    const AxisContext context{i, a, t_s, head_degC(i, t_s), v};
    for (const auto& effect : scenario_.effects) y[a] += effect->axis_nT(context);
    y[a] += noise();
  }
  return y;
}

double World::head_degC(int i, double t_s) const {
  const TemperatureScript& s = scenario_.temperature;
  return s.start_degC + s.ramp_degC_per_h * t_s / 3600 + s.head_degC.at(static_cast<std::size_t>(i));
}

double World::read_scalar(double t_s) {
  return site_field(t_s, Eigen::Vector3d::Zero()).norm() + scenario_.scalar_noise_nT * normal_(random_);
}

}  // namespace mgtd::rig
