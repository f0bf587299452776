// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <span>

#include "proto/error.h"

/// dipole_field_nT() computes the field of a point dipole, D(d) = 100 nT m^3/(A m^2) (3 (m u) u - m)/|d|^3,
/// u = d/|d|, d from the dipole to the point (m), m its moment (A m^2). The factor is mu0/4 pi.
namespace mgtd::calib::effects {
struct EffectSpec;
}  // namespace mgtd::calib::effects

namespace mgtd::calib::effects::laws {

template <class S>
[[nodiscard]] std::array<S, 3> dipole_field_nT(std::span<const S> m, const std::array<S, 3>& d) {
  using std::sqrt;
  constexpr double kDipole_nT_m3_per_Am2 = 100;
  const S r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const S scale = S(kDipole_nT_m3_per_Am2) / (r2 * sqrt(r2));
  const S along = (m[0] * d[0] + m[1] * d[1] + m[2] * d[2]) * S(3.0) / r2;
  return {(along * d[0] - m[0]) * scale, (along * d[1] - m[1]) * scale, (along * d[2] - m[2]) * scale};
}

/// x, y, z of a spec: where a dipole is started, site frame, metres. Refuses the centre of the array.
[[nodiscard]] Result<Eigen::Vector3d> dipole_place_S_m(const EffectSpec& spec);
/// The reverse.
void set_dipole_place(const Eigen::Vector3d& place_S_m, EffectSpec& spec);

}  // namespace mgtd::calib::effects::laws
