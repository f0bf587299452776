// SPDX-License-Identifier: Apache-2.0
#include "tests/support/paper_rigs.h"

#include <cmath>
#include <numbers>
#include <random>

namespace mgtd::testing {
namespace {

constexpr double kDeg = std::numbers::pi / 180;
using Vec = std::array<double, 3>;

Vec turn_x(const Vec& v, double a) {
  return {v[0], std::cos(a) * v[1] + std::sin(a) * v[2], -std::sin(a) * v[1] + std::cos(a) * v[2]};
}
Vec turn_y(const Vec& v, double b) {
  return {std::cos(b) * v[0] - std::sin(b) * v[2], v[1], std::sin(b) * v[0] + std::cos(b) * v[2]};
}
Vec turn_z(const Vec& v, double g) {
  return {std::cos(g) * v[0] + std::sin(g) * v[1], -std::sin(g) * v[0] + std::cos(g) * v[1], v[2]};
}

/// The gradient's share at the sensor: positions on the arms of the cross, s1 +X, s2 +Y, s3 -X, s4 -Y.
Vec gradient_at(const Site& site, std::size_t sensor, const Vec& angles_rad) {
  constexpr std::array<double, 4> kX{1, 0, -1, 0}, kY{0, 1, 0, -1};
  const Vec r_P{kX.at(sensor) * site.baseline_m / 2, kY.at(sensor) * site.baseline_m / 2, 0};
  const Vec x = turn_x(turn_y(turn_z(r_P, -angles_rad[0]), -angles_rad[1]), -angles_rad[2]);
  const auto& g = site.gradient_nT_per_m;
  const Vec b{g[0] * x[0] + g[2] * x[1] + g[3] * x[2], g[2] * x[0] + g[1] * x[1] + g[4] * x[2],
              g[3] * x[0] + g[4] * x[1] - (g[0] + g[1]) * x[2]};
  return turn_z(turn_y(turn_x(b, angles_rad[2]), angles_rad[1]), angles_rad[0]);
}

}  // namespace

// Eq. 5 after the inverse of eqs. 13-14: platform field to reading.
Vec reading(const SensorTruth& p, const Vec& b_P) {
  const Vec s = turn_x(turn_y(turn_z(b_P, -p[11] * kDeg), -p[10] * kDeg), -p[9] * kDeg);
  const double t = p[0] * kDeg, f = p[1] * kDeg, q = p[2] * kDeg;
  return {p[3] * (std::cos(t) * std::cos(f) * s[0] + std::sin(t) * std::cos(f) * s[1] + std::sin(f) * s[2]) +
              p[6],
          p[4] * (std::cos(q) * s[1] + std::sin(q) * s[2]) + p[7], p[5] * s[2] + p[8]};
}

RigTruth table3_rig() {
  return {{{-1.9, 1.6, 2.3, 0.988, 1.105, 1.054, 234, 114, -218, 2.5, -2.2, 1.7},
           {1.8, 1.1, 3.2, 0.991, 1.152, 0.897, -312, 154, 98, -2.0, 1.7, 3.3},
           {2.3, 1.5, -1.8, 1.101, 0.926, 1.084, 230, -142, 195, 1.3, 2.1, -2.5},
           {1.5, -2.3, -2.9, 0.915, 1.084, 1.118, 251, -221, -308, -2.1, 1.4, 2.7}}};
}

RigTruth table6_rig() {
  return {{{-0.252, -3.478, 0.865, 0.999, 1.003, 0.992, 351.9, -170.9, -123.7, 0.682, -0.882, -2.177},
           {0.705, 3.077, 0.900, 1.008, 1.002, 0.999, 363.4, 412.6, -139.4, -0.899, 0.241, 1.644},
           {-0.126, -3.146, -1.719, 0.995, 1.003, 0.998, -87.4, 79.1, -102.9, -0.487, 0.785, -1.381},
           {0.814, 3.174, 2.515, 1.006, 1.004, 0.998, -301.0, -298.8, -29.7, 0.693, -0.160, 1.902}}};
}

PoseTable measure(const RigTruth& rig, const Site& site, const std::vector<AttitudeDeg>& attitudes,
                  std::size_t standard, const Noise& noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&] {
    return noise.size_nT * (noise.kind == Noise::Kind::gaussian ? normal(random) : uniform(random));
  };
  const double h = site.f_nT * std::cos(site.inclination_deg * kDeg);
  const Vec B{h * std::cos(site.declination_deg * kDeg), h * std::sin(site.declination_deg * kDeg),
              site.f_nT * std::sin(site.inclination_deg * kDeg)};
  PoseTable table;
  for (std::size_t k = 0; k < attitudes.size(); ++k) {
    const AttitudeDeg& a = attitudes[k];
    const auto wrong = [&](double angle_deg) {
      return (angle_deg + noise.table_sd_deg * normal(random)) * kDeg;
    };
    const double azimuth = wrong(a.azimuth), pitch = wrong(a.pitch), roll = wrong(a.roll);
    const Vec b_P = turn_z(turn_y(turn_x(B, roll), pitch), azimuth);
    Pose pose;
    pose.number = static_cast<int>(k) + 1;
    pose.set = k < standard ? "standard" : "random";
    pose.t_s = 15.0 * static_cast<double>(k);
    pose.azimuth_rad = a.azimuth * kDeg;
    pose.pitch_rad = a.pitch * kDeg;
    pose.roll_rad = a.roll * kDeg;
    pose.f_nT = site.f_nT;
    if (noise.f_sd_nT > 0) {
      pose.f_nT = site.f_nT + noise.f_sd_nT * normal(random);
      pose.f_sd_nT = noise.f_sd_nT;
    }
    pose.n = 1;
    for (std::size_t i = 0; i < rig.size(); ++i) {
      const Vec extra = gradient_at(site, i, {azimuth, pitch, roll});
      const Vec y = reading(rig[i], {b_P[0] + extra[0], b_P[1] + extra[1], b_P[2] + extra[2]});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        pose.y_nT.at(i)[static_cast<Eigen::Index>(axis)] = y[axis] + draw();
        if (noise.size_nT > 0) {
          pose.sd_nT.at(i).at(axis) =
              noise.kind == Noise::Kind::gaussian ? noise.size_nT : noise.size_nT / std::sqrt(3.0);
        }
      }
    }
    table.poses.push_back(pose);
  }
  return table;
}

std::vector<AttitudeDeg> grid_5832() {
  std::vector<AttitudeDeg> out;
  for (int roll = 0; roll < 18; ++roll) {
    for (int pitch = 0; pitch < 18; ++pitch) {
      for (int azimuth = 0; azimuth < 18; ++azimuth)
        out.push_back({20.0 * azimuth, 20.0 * pitch, 20.0 * roll});
    }
  }
  return out;
}

std::vector<AttitudeDeg> standard_run(std::size_t random_poses, std::uint64_t seed) {
  std::vector<AttitudeDeg> out;
  for (int k = 0; k < 18; ++k) out.push_back({20.0 * k, 0, 0});
  for (int k = 17; k >= 0; --k) out.push_back({20.0 * k + 10, 0, 0});
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t k = 0; k < random_poses; ++k) {
    // Uniform over attitudes: the sine of the middle angle is uniform.
    out.push_back({360 * unit(random), std::asin(2 * unit(random) - 1) / kDeg, 360 * unit(random) - 180});
  }
  return out;
}

}  // namespace mgtd::testing
