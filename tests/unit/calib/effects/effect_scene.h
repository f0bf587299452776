// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <random>

#include "tests/unit/calib/fit/simulated_poses.h"

/// Runs with one effect put in, level by level, for the tests of the library. The equations of the effects
/// are written out in the tests; nothing here or there uses the effects' own code.
namespace mgtd::calib::testing {

/// What the rig does beyond the twelve parameters; each is null when it does nothing.
struct Injection {
  std::function<Eigen::Vector3d(double t_h, const Eigen::Vector3d& x_S_m)> site{};
  /// True site to platform, instead of the recorded one.
  std::function<Eigen::Matrix3d(const Pose&)> attitude{};
  /// The field a sensor sees, given the field at its place.
  std::function<Eigen::Vector3d(const Pose&, int sensor, const Eigen::Vector3d& b, const Eigen::Vector3d& g)>
      platform{};
  /// Added to the reading; v of the pose before, null at the first.
  std::function<double(const Pose&, int sensor, int axis, const Eigen::Vector3d& v,
                       const Eigen::Vector3d* v_before)>
      axis{};
  /// Added to the scalar reference.
  std::function<double(const Pose&, const Eigen::Vector3d& u_P)> reference{};
};

struct Scene {
  double noise_nT = 0.3, table_sd_rad = to_rad(0.02), f_sd_nT = 0.05;
  double f_nT = 50'000;
  int standard = 36, random = 121;
  bool with_f = true;  ///< a scalar reference
  Eigen::Vector3d direction{std::cos(to_rad(60)), 0, std::sin(to_rad(60))};
};

/// Covariates of pose k of n: temperatures up and down twice, a current switched at random, a mounting in
/// thirds.
inline void add_covariates(Pose& pose, int k, int n, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> unit(0, 1);
  pose.number = k + 1;
  pose.t_s = 60.0 * k;
  const double phase = 2 * std::numbers::pi * k / n;
  for (std::size_t i = 0; i < kSensors; ++i)
    pose.T_degC[i] = 24 + 5 * std::sin(2 * phase + 0.7 * static_cast<double>(i)) + unit(rng);
  pose.covariates["motor_A"] = unit(rng) < 0.5 ? 0.0 : 1.5;
  pose.mount = 1 + 3 * k / n;
  pose.sense = unit(rng) < 0.5 ? -1 : 1;
  pose.since_stop_s = 5 + 40 * unit(rng);
}

inline TableAngles angles_of(const Scene& scene, int k, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> turn(-std::numbers::pi, std::numbers::pi), z(-1, 1);
  const TableAngles any{turn(rng), std::asin(z(rng)), turn(rng)};
  return k < scene.standard ? TableAngles{2 * std::numbers::pi * k / scene.standard, 0, 0} : any;
}

inline PoseTable run_with(const Injection& in, const Scene& scene, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  const Rig rig = table6_rig();
  const auto r = sensor::Geometry{}.positions_P_m();
  PoseTable table;
  PerSensor<Eigen::Vector3d> before;
  const int n = scene.standard + scene.random;
  for (int k = 0; k < n; ++k) {
    Pose pose;
    add_covariates(pose, k, n, rng);
    const TableAngles a = angles_of(scene, k, rng);
    pose.set = k < scene.standard ? "standard" : "random";
    pose.azimuth_rad = a.azimuth_rad, pose.pitch_rad = a.pitch_rad, pose.roll_rad = a.roll_rad;
    const Eigen::Vector3d w = scene.table_sd_rad * Eigen::Vector3d{normal(rng), normal(rng), normal(rng)};
    const Eigen::Matrix3d R = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix() *
                              (in.attitude ? in.attitude(pose) : attitude(a));
    const double t_h = *pose.t_s / 3600;
    Eigen::Vector3d B0 = scene.f_nT * scene.direction;
    if (in.site) B0 += in.site(t_h, Eigen::Vector3d::Zero());
    if (scene.with_f) {
      pose.f_nT = B0.norm() + scene.f_sd_nT * normal(rng);
      if (in.reference) *pose.f_nT += in.reference(pose, R * B0.normalized());
      pose.f_sd_nT = scene.f_sd_nT;
    }
    for (int i = 0; i < kSensors; ++i) {
      const auto s = static_cast<std::size_t>(i);
      Eigen::Vector3d B = scene.f_nT * scene.direction;
      if (in.site) B += in.site(t_h, R.transpose() * r[s]);
      Eigen::Vector3d b = R * B;
      if (in.platform) b = in.platform(pose, i, b, R.col(2));
      const Eigen::Vector3d v = rig[s].predict(b) - rig[s].offset_nT;
      pose.y_nT[s] = v + rig[s].offset_nT;
      for (int axis = 0; axis < 3; ++axis) {
        if (in.axis) pose.y_nT[s][axis] += in.axis(pose, i, axis, v, k > 0 ? &before[s] : nullptr);
        pose.y_nT[s][axis] += scene.noise_nT * normal(rng);
        pose.sd_nT[s][static_cast<std::size_t>(axis)] = 10 * scene.noise_nT;
      }
      before[s] = v;
    }
    pose.n = 100;
    table.poses.push_back(pose);
  }
  return table;
}

}  // namespace mgtd::calib::testing
