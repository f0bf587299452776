// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "proto/pose.h"

/// These are rigs with known parameters and runs on them, written from the paper's equations and not from
/// calib: what an estimator is judged by must not share its code.
namespace mgtd::testing {

/// theta, phi, psi (deg), cx, cy, cz, ix, iy, iz (nT), alpha, beta, gamma (deg).
using SensorTruth = std::array<double, 12>;
using RigTruth = std::array<SensorTruth, 4>;

[[nodiscard]] RigTruth table3_rig();  ///< preset parameters of the paper's simulation
[[nodiscard]] RigTruth table6_rig();  ///< of its experiment, first site

struct Site {
  double f_nT{50'000}, inclination_deg{60}, declination_deg{-5};
  /// Gxx, Gyy, Gxy, Gxz, Gyz in the site frame: the field at x is B + G x, F and B are those at the centre.
  std::array<double, 5> gradient_nT_per_m{};
  double baseline_m{0.4};
};

struct AttitudeDeg {
  double azimuth{0}, pitch{0}, roll{0};
};

struct Noise {
  enum class Kind { gaussian, uniform } kind{Kind::gaussian};
  double size_nT{0};       ///< standard deviation, or half width of the uniform
  double table_sd_deg{0};  ///< true angles less the reported ones
  double f_sd_nT{0};       ///< of the scalar reference; zero: exact, and no f_sd_nT is reported
};

/// What a sensor reads in this field of the platform frame.
[[nodiscard]] std::array<double, 3> reading(const SensorTruth& sensor, const std::array<double, 3>& b_P_nT);

/// One run: a pose per attitude; the first `standard` ones belong to the standard set.
[[nodiscard]] PoseTable measure(const RigTruth& rig, const Site& site,
                                const std::vector<AttitudeDeg>& attitudes, std::size_t standard,
                                const Noise& noise, std::uint64_t seed);

/// 18 x 18 x 18 attitudes: 20 degree steps about Z, then Y, then X; the level turn first.
[[nodiscard]] std::vector<AttitudeDeg> grid_5832();
/// 36 level azimuths in the order of a run (20 degree steps out, those between on the way back), then random
/// attitudes.
[[nodiscard]] std::vector<AttitudeDeg> standard_run(std::size_t random, std::uint64_t seed);

}  // namespace mgtd::testing
