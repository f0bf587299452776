// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effects/temperature_law.h"

#include <Eigen/LU>
#include <cmath>

#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

struct Parabola {
  double c0, c1, c2;
  [[nodiscard]] double at(double T_degC) const { return c0 + T_degC * (c1 + T_degC * c2); }
};

struct SensorLaw {
  int serial;
  std::array<Parabola, 3> offset_nT, scale, angle_arcsec;
};

// clang-format off
constexpr std::array<SensorLaw, 4> kLaws{{
    {687,  // serial
     {{{25.837, 1.3642, -0.058418}, {84.498, -4.6222, 0.048285}, {37.862, -2.8216, 0.0032608}}},
     {{{0.99397, 0.00021563, 4.1443e-07}, {0.99141, 0.00026452, 5.8845e-06}, {0.99623, 0.00017733, 1.6337e-06}}},
     {{{-197.81, 33.499, -0.69658}, {375.91, 17.633, -0.46883}, {238.68, -11.479, 0.044622}}},
    },
    {688,  // serial
     {{{108.28, -4.4685, 0.0015674}, {31.393, -0.72391, -0.030317}, {-45.188, 1.6138, -0.0096169}}},
     {{{0.99784, 6.976e-06, 6.4954e-06}, {0.98097, 0.00046894, -5.682e-06}, {0.998, 2.9658e-05, 5.8352e-06}}},
     {{{-199.24, 11.182, -0.42256}, {282.09, -8.9838, -0.084534}, {42.962, -20.321, 0.28916}}},
    },
    {689,  // serial
     {{{32.603, -1.7135, 0.067599}, {-62.389, 7.4899, -0.15924}, {42.883, -1.2902, -0.055892}}},
     {{{0.99537, 0.0001142, 7.7696e-06}, {0.99078, 0.0002468, 7.1949e-06}, {0.99659, 1.331e-05, 8.2567e-06}}},
     {{{113.65, 1.7461, -0.28297}, {-475.47, 6.822, -0.41443}, {91.459, -12.848, 0.53951}}},
    },
    {690,  // serial
     {{{-58.421, -1.958, 0.061023}, {41.01, -8.5493, 0.30701}, {227.85, 4.0855, -0.18867}}},
     {{{0.99381, 0.00024977, 2.7546e-06}, {0.98771, 0.00063261, -5.0385e-06}, {0.99634, 0.00012419, 5.662e-06}}},
     {{{435.02, -9.6061, 0.20449}, {193.36, 6.2856, 0.1021}, {-189.36, 2.2936, -0.18431}}},
    },
}};
// clang-format on

Eigen::Matrix3d axes(const SensorLaw& law, double T_degC) {
  std::array<double, 3> u{};
  for (std::size_t i = 0; i < 3; ++i) u.at(i) = law.angle_arcsec.at(i).at(T_degC) / 3600 * kDeg;
  const double s2 = std::sin(u[1]), s3 = std::sin(u[2]);
  return Eigen::Matrix3d{
      {1, 0, 0}, {-std::sin(u[0]), std::cos(u[0]), 0}, {s2, s3, std::sqrt(1 - s2 * s2 - s3 * s3)}};
}

}  // namespace

double TemperatureLaw::axis_nT(const AxisContext& c) const {
  Change& change = change_.at(static_cast<std::size_t>(c.sensor));
  if (change.T_degC != c.T_degC) {
    const SensorLaw& law = kLaws.at(static_cast<std::size_t>(c.sensor) % kLaws.size());
    change.T_degC = c.T_degC;
    change.gain = axes(law, c.T_degC) * axes(law, kT0_degC).inverse();
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      change.gain.row(a) *= law.scale.at(i).at(c.T_degC) / law.scale.at(i).at(kT0_degC);
      change.offset_nT[a] = law.offset_nT.at(i).at(c.T_degC) - law.offset_nT.at(i).at(kT0_degC);
    }
    change.gain -= Eigen::Matrix3d::Identity();
  }
  return change.gain.row(c.axis) * c.v_nT + change.offset_nT[c.axis];
}

}  // namespace mgtd::rig
