// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/reading.h"

/// An array that is mounted on the table in another way. Table turned by R_T, array turned on it by M, both
/// in the order Rz(azimuth) Ry(pitch) Rx(roll):
///
///     b_P = M R_T B_site = Rz(a) Ry(p) Rx(r) B_site
///
/// and a, p, r are what the pose table records. At p = +-90 deg, where azimuth and roll turn about one axis,
/// the roll is 0.
namespace mgtd::daemon {

[[nodiscard]] TableAngles platform_angles(const TableAngles& mounting, const TableAngles& table);

}  // namespace mgtd::daemon
