// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "calib/sensor/geometry.h"
#include "calib/sensor/sensor_model.h"
#include "proto/pose.h"
#include "proto/units.h"

/// Pose tables with a known truth for the tests of the fits. The rotations are written with Eigen's
/// AngleAxis, not with the code under test.
namespace mgtd::calib::testing {

using Rig = PerSensor<sensor::SensorModel>;

inline sensor::SensorModel sensor(double theta_deg, double phi_deg, double psi_deg, Eigen::Vector3d c,
                                  Eigen::Vector3d i_nT, double alpha_deg, double beta_deg, double gamma_deg) {
  return {.theta_rad = to_rad(theta_deg),
          .phi_rad = to_rad(phi_deg),
          .psi_rad = to_rad(psi_deg),
          .scale = c,
          .offset_nT = i_nT,
          .alpha_rad = to_rad(alpha_deg),
          .beta_rad = to_rad(beta_deg),
          .gamma_rad = to_rad(gamma_deg)};
}

/// The paper's Table 3: the simulated rig.
inline Rig table3_rig() {
  return {sensor(-1.9, 1.6, 2.3, {0.988, 1.105, 1.054}, {234, 114, -218}, 2.5, -2.2, 1.7),
          sensor(1.8, 1.1, 3.2, {0.991, 1.152, 0.897}, {-312, 154, 98}, -2.0, 1.7, 3.3),
          sensor(2.3, 1.5, -1.8, {1.101, 0.926, 1.084}, {230, -142, 195}, 1.3, 2.1, -2.5),
          sensor(1.5, -2.3, -2.9, {0.915, 1.084, 1.118}, {251, -221, -308}, -2.1, 1.4, 2.7)};
}

/// The paper's Table 6, first site: the real rig.
inline Rig table6_rig() {
  return {
      sensor(-0.252, -3.478, 0.865, {0.999, 1.003, 0.992}, {351.9, -170.9, -123.7}, 0.682, -0.882, -2.177),
      sensor(0.705, 3.077, 0.900, {1.008, 1.002, 0.999}, {363.4, 412.6, -139.4}, -0.899, 0.241, 1.644),
      sensor(-0.126, -3.146, -1.719, {0.995, 1.003, 0.998}, {-87.4, 79.1, -102.9}, -0.487, 0.785, -1.381),
      sensor(0.814, 3.174, 2.515, {1.006, 1.004, 0.999}, {-301.0, -298.8, -29.7}, 0.693, -0.160, 1.902)};
}

struct Simulation {
  Rig rig = table6_rig();
  double f_nT = 53907.7;
  double inclination_rad = to_rad(60), declination_rad = to_rad(-5);
  double noise_nT = 1;
  double table_sd_rad = 0;                               ///< true attitude minus recorded angles
  double f_sd_nT = 0;                                    ///< error of the scalar reference
  double f_drift_nT = 0;                                 ///< amplitude of the field's change over the run
  Eigen::Matrix3d G_nT_per_m = Eigen::Matrix3d::Zero();  ///< site gradient
  sensor::Geometry geometry{};
  bool with_angles = true, with_f = true;
};

inline Eigen::Matrix3d passive(double angle, int axis) {
  return Eigen::AngleAxisd(-angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
}

inline Eigen::Matrix3d attitude(const TableAngles& a) {
  return passive(a.azimuth_rad, 2) * passive(a.pitch_rad, 1) * passive(a.roll_rad, 0);
}

/// 50 nT/m scale, symmetric and traceless.
inline Eigen::Matrix3d gradient_50() {
  Eigen::Matrix3d g;
  g << 30, -20, 50, -20, -45, 10, 50, 10, 15;
  return g;
}

inline Pose measure(const Simulation& sim, const TableAngles& angles, int number, double phase,
                    std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  Pose pose;
  pose.number = number;
  pose.t_s = 30.0 * number;
  const double f = sim.f_nT + sim.f_drift_nT * std::sin(2 * std::numbers::pi * phase);
  const double ci = std::cos(sim.inclination_rad);
  const Eigen::Vector3d B_S =
      f * Eigen::Vector3d{ci * std::cos(sim.declination_rad), ci * std::sin(sim.declination_rad),
                          std::sin(sim.inclination_rad)};
  const Eigen::Vector3d w = sim.table_sd_rad * Eigen::Vector3d{normal(rng), normal(rng), normal(rng)};
  Eigen::Matrix3d R = attitude(angles);
  if (w.norm() > 0) R = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix() * R;
  const auto r = sim.geometry.positions_P_m();
  for (std::size_t i = 0; i < kSensors; ++i) {
    pose.y_nT[i] = sim.rig[i].predict(R * (B_S + sim.G_nT_per_m * R.transpose() * r[i]));
    for (int a = 0; a < 3; ++a) pose.y_nT[i][a] += sim.noise_nT * normal(rng);
  }
  if (sim.with_f) {
    pose.f_nT = f + sim.f_sd_nT * normal(rng);
    pose.f_sd_nT = std::max(sim.f_sd_nT, 0.05);
  }
  if (sim.with_angles) {
    pose.azimuth_rad = angles.azimuth_rad;
    pose.pitch_rad = angles.pitch_rad;
    pose.roll_rad = angles.roll_rad;
  }
  return pose;
}

/// `standard` level poses around the azimuth circle, then `random` poses over the whole sphere.
inline PoseTable simulate(const Simulation& sim, int standard, int random, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<double> turn(-std::numbers::pi, std::numbers::pi), z(-1, 1);
  PoseTable table;
  for (int k = 0; k < standard + random; ++k) {
    const TableAngles level{2 * std::numbers::pi * k / standard, 0, 0};
    const TableAngles any{turn(rng), std::asin(z(rng)), turn(rng)};
    table.poses.push_back(
        measure(sim, k < standard ? level : any, k + 1, static_cast<double>(k) / (standard + random), rng));
    table.poses.back().set = k < standard ? "standard" : "random";
  }
  return table;
}

}  // namespace mgtd::calib::testing
