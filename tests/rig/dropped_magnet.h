// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <limits>

#include "tests/rig/vehicle.h"

namespace mgtd::rig {

/// A DroppedMagnet is something magnetic that is put down near the array, and may be taken away again.
struct DroppedMagnet {
  double at_s{0}, until_s{std::numeric_limits<double>::infinity()};
  std::array<double, 3> moment_Am2{}, at_m{};  ///< site frame, from the centre of the array

  [[nodiscard]] Eigen::Vector3d field_nT(double t_s, const Eigen::Vector3d& x_m) const {
    if (t_s < at_s || t_s >= until_s) return {0, 0, 0};
    return dipole_nT(Eigen::Vector3d(moment_Am2.data()), x_m - Eigen::Vector3d(at_m.data()));
  }
};

}  // namespace mgtd::rig
