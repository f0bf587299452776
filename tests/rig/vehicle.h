// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>

namespace mgtd::rig {

/// This gives the field of a dipole at `from_dipole_m`, nT: mu0/4pi (3 (m.u) u - m)/d^3; 100 nT at 1 m for 1
/// A m2 across the moment.
inline Eigen::Vector3d dipole_nT(const Eigen::Vector3d& moment_Am2, const Eigen::Vector3d& from_dipole_m) {
  constexpr double kMu0Over4Pi_nT = 100;  // 1e-7 T m/A in nT
  const Eigen::Vector3d u = from_dipole_m.normalized();
  return kMu0Over4Pi_nT * (3 * moment_Am2.dot(u) * u - moment_Am2) /
         (from_dipole_m.norm() * from_dipole_m.squaredNorm());
}

/// Passes the array on a straight road along Y, `nearest_m` away in X, and may stand there for a while.
struct Vehicle {
  double at_s{0};  ///< nearest
  double nearest_m{15}, speed_m_per_s{10};
  double stands_s{0};
  double moment_Am2{500};  ///< along the field: what iron has that the field magnetises

  [[nodiscard]] Eigen::Vector3d field_nT(double t_s, const Eigen::Vector3d& x_m,
                                         const Eigen::Vector3d& along) const {
    const double since_s = std::min(t_s - at_s, 0.0) + std::max(t_s - at_s - stands_s, 0.0);
    const Eigen::Vector3d at_m(nearest_m, speed_m_per_s * since_s, 0);
    return dipole_nT(moment_Am2 * along, x_m - at_m);
  }
};

}  // namespace mgtd::rig
