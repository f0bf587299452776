// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>

#include "tests/rig/rotations.h"

namespace mgtd::rig {

/// A VectorReference measures the field as a vector, in axes of its own:
///
///     R r = b + noise,   R = Rz(rz) Ry(ry) Rx(rx)
///
/// b is the field at the centre of the array in the platform frame, where the reference is fixed to what
/// holds the sensors (or where a coil cage makes the field), or the field in the site frame where it stands
/// still beside the table. The angles may be of any size. Its scale is right and it has no offset.
struct VectorReference {
  double sd_nT{0.1};                         ///< of each component at each pose
  std::array<double, 3> misalignment_deg{};  ///< rx, ry, rz
  bool on_platform{true};
  std::array<double, 3> at_m{};  ///< beside the table: its place from the centre of the array, site frame

  [[nodiscard]] Eigen::Matrix3d R() const {
    return about_z(misalignment_deg[2]) * about_y(misalignment_deg[1]) * about_x(misalignment_deg[0]);
  }
};

}  // namespace mgtd::rig
