// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "tests/unit/calib/fit/simulated_poses.h"

/// This makes runs with something hidden in them: the physics of sensors, site and table written without the
/// estimator's code.
namespace mgtd::calib::testing {

/// Added to the reading of axis `axis` of sensor `sensor`, whose field term is v (nT).
using Hidden = std::function<double(const Pose& pose, int sensor, int axis, const Eigen::Vector3d& v)>;

enum class Tail { gaussian, student3, outliers };

struct HiddenRun {
  double noise_nT{0.3};
  bool spreads{true};  ///< the table tells the noise
  double rho{0};       ///< of the noise from pose to pose
  Tail tail{Tail::gaussian};
  Hidden hidden{};
  Eigen::Matrix3d G_nT_per_m{Eigen::Matrix3d::Zero()};
  int unseen{0};  ///< further random poses among the others, of the set "check"
};

/// One number with unit variance; Student's t with three degrees of freedom has three without the factor.
inline double heavy(std::mt19937_64& rng, Tail tail) {
  if (tail == Tail::student3) return std::student_t_distribution<double>(3)(rng) / std::sqrt(3.0);
  return std::normal_distribution<double>()(rng);
}

/// 36 level and 121 random poses of the Table 6 rig, half a minute each; the heads warm up and cool down by
/// three degrees. `outliers`: three readings are 15 standard deviations off.
inline PoseTable hidden_run(const HiddenRun& run, std::uint64_t seed) {
  Simulation sim{.noise_nT = 0, .table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05, .f_drift_nT = 20};
  sim.G_nT_per_m = run.G_nT_per_m;
  PoseTable table = simulate(sim, 36, 121 + run.unseen, seed);
  for (int k = 0; k < run.unseen; ++k)
    table.poses[static_cast<std::size_t>(36 + k * (121 + run.unseen) / run.unseen)].set = "check";
  std::mt19937_64 rng(seed ^ 0x9e3779b97f4a7c15U);
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, 12, 1> n = Eigen::Matrix<double, 12, 1>::NullaryExpr([&] { return normal(rng); });
  const double fresh = std::sqrt(1 - run.rho * run.rho);
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    Pose& pose = table.poses[k];
    const double phase = static_cast<double>(k) / static_cast<double>(table.poses.size());
    for (std::size_t i = 0; i < 4; ++i)
      pose.T_degC[i] = 21 + 3 * std::sin(5 * phase + 0.3 * static_cast<double>(i)) + 0.2 * normal(rng);
    for (int c = 0; c < 12; ++c) {
      const auto i = static_cast<std::size_t>(c / 3);
      n[c] = run.rho * n[c] + fresh * heavy(rng, run.tail);
      const Eigen::Vector3d v = pose.y_nT[i] - sim.rig[i].offset_nT;
      const double extra = run.hidden ? run.hidden(pose, c / 3, c % 3, v) : 0;
      pose.y_nT[i][c % 3] += extra + run.noise_nT * n[c];
      if (run.spreads) pose.sd_nT[i][static_cast<std::size_t>(c % 3)] = run.noise_nT;
    }
    if (run.spreads) pose.n = 1;
  }
  for (int k = 0; run.tail == Tail::outliers && k < 3; ++k) {
    Pose& pose = table.poses[rng() % table.poses.size()];
    pose.y_nT[rng() % 4][static_cast<Eigen::Index>(rng() % 3)] += (k % 2 == 0 ? 15 : -15) * run.noise_nT;
  }
  return table;
}

}  // namespace mgtd::calib::testing
