// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/truth.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <sstream>

#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

SensorTruth sensor(double theta, double phi, double psi, double cx, double cy, double cz, double ix,
                   double iy, double iz, double alpha, double beta, double gamma) {
  return {theta, phi, psi, {cx, cy, cz}, {ix, iy, iz}, alpha, beta, gamma, Eigen::Matrix3d::Identity()};
}

RigTruth random_rig(std::uint64_t seed, std::size_t sensors) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  RigTruth rig(sensors);
  for (SensorTruth& s : rig) {
    std::array<double, 12> d{};  // drawn from the last to the first: what a seed makes stays as it was
    std::generate(d.rbegin(), d.rend(), [&] { return unit(random); });
    s = sensor(3 * d[0], 3 * d[1], 3 * d[2], 1 + 0.05 * d[3], 1 + 0.05 * d[4], 1 + 0.05 * d[5], 400 * d[6],
               400 * d[7], 400 * d[8], 3 * d[9], 3 * d[10], 3 * d[11]);
  }
  return rig;
}

}  // namespace

Eigen::Matrix3d SensorTruth::matrix() const {
  const double ct = std::cos(theta_deg * kDeg), st = std::sin(theta_deg * kDeg);
  const double cf = std::cos(phi_deg * kDeg), sf = std::sin(phi_deg * kDeg);
  const double cp = std::cos(psi_deg * kDeg), sp = std::sin(psi_deg * kDeg);
  const Eigen::Matrix3d axes{{ct * cf, st * cf, sf}, {0, cp, sp}, {0, 0, 1}};
  const Eigen::Matrix3d to_platform = about_z(gamma_deg) * about_y(beta_deg) * about_x(alpha_deg) * mounting;
  return scale.asDiagonal() * axes * to_platform.transpose();
}

bool of_the_cross(std::string_view name) { return name == "table3" || name == "table6"; }

std::optional<RigTruth> rig_named(std::string_view name, std::uint64_t seed, std::size_t sensors) {
  if (name == "ideal") return RigTruth(sensors);
  if (name == "random") return random_rig(seed, sensors);
  if (sensors != kCross) return std::nullopt;
  if (name == "table3") {
    return RigTruth{sensor(-1.9, 1.6, 2.3, 0.988, 1.105, 1.054, 234, 114, -218, 2.5, -2.2, 1.7),
                    sensor(1.8, 1.1, 3.2, 0.991, 1.152, 0.897, -312, 154, 98, -2.0, 1.7, 3.3),
                    sensor(2.3, 1.5, -1.8, 1.101, 0.926, 1.084, 230, -142, 195, 1.3, 2.1, -2.5),
                    sensor(1.5, -2.3, -2.9, 0.915, 1.084, 1.118, 251, -221, -308, -2.1, 1.4, 2.7)};
  }
  if (name == "table6") {
    return RigTruth{
        sensor(-0.252, -3.478, 0.865, 0.999, 1.003, 0.992, 351.9, -170.9, -123.7, 0.682, -0.882, -2.177),
        sensor(0.705, 3.077, 0.900, 1.008, 1.002, 0.999, 363.4, 412.6, -139.4, -0.899, 0.241, 1.644),
        sensor(-0.126, -3.146, -1.719, 0.995, 1.003, 0.998, -87.4, 79.1, -102.9, -0.487, 0.785, -1.381),
        sensor(0.814, 3.174, 2.515, 1.006, 1.004, 0.998, -301.0, -298.8, -29.7, 0.693, -0.160, 1.902)};
  }
  return std::nullopt;
}

std::array<std::pair<const char*, double*>, 12> named_parameters(SensorTruth& t) {
  return {{{"theta_deg", &t.theta_deg},
           {"phi_deg", &t.phi_deg},
           {"psi_deg", &t.psi_deg},
           {"cx", &t.scale[0]},
           {"cy", &t.scale[1]},
           {"cz", &t.scale[2]},
           {"ix_nT", &t.offset_nT[0]},
           {"iy_nT", &t.offset_nT[1]},
           {"iz_nT", &t.offset_nT[2]},
           {"alpha_deg", &t.alpha_deg},
           {"beta_deg", &t.beta_deg},
           {"gamma_deg", &t.gamma_deg}}};
}

std::optional<Eigen::Matrix3d> parse_mounting(std::string_view text) {
  std::istringstream in{std::string(text)};
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  int column = 0;
  for (std::string word; in >> word; ++column) {
    const bool against = word.front() == '-';
    const std::string_view letter = std::string_view(word).substr(against ? 1 : 0);
    if (column > 2 || letter.size() != 1 || letter[0] < 'x' || letter[0] > 'z') return std::nullopt;
    out(letter[0] - 'x', column) = against ? -1 : 1;
  }
  if (column != 3 || out.determinant() == 0) return std::nullopt;
  return out;
}

std::string mounting_text(const Eigen::Matrix3d& mounting) {
  std::string out;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      if (mounting(row, column) == 0) continue;
      if (!out.empty()) out += ' ';
      if (mounting(row, column) < 0) out += '-';
      out += static_cast<char>('x' + row);
    }
  }
  return out;
}

}  // namespace mgtd::rig
