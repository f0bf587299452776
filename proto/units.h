// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>

/// Inside the program, units are nT, nT/m, m, s, rad and degC. Degrees exist only at the edges (wire, config,
/// tables, screen), and cross that edge here.
namespace mgtd {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

[[nodiscard]] constexpr double to_rad(double angle_deg) { return angle_deg * kRadiansPerDegree; }
[[nodiscard]] constexpr double to_deg(double angle_rad) { return angle_rad / kRadiansPerDegree; }

/// Field magnitudes that can occur on Earth, with margin: 22 to 67 uT at the surface.
inline constexpr double kEarthFieldMin_nT = 15'000.0;
inline constexpr double kEarthFieldMax_nT = 80'000.0;

}  // namespace mgtd
