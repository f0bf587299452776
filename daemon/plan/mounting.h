// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/reading.h"

/// A mounting says how the array sits on the table. With the table turned by R_T and the array turned on it
/// by M, both in the order Rz(azimuth) Ry(pitch) Rx(roll),
///
///     b_P = M R_T B_site = Rz(a) Ry(p) Rx(r) B_site
///
/// and a, p, r are what the pose table records. At p = +-90 deg, where azimuth and roll turn about one axis,
/// the roll is 0.
namespace mgtd::daemon::plan {

[[nodiscard]] TableAngles platform_angles(const TableAngles& mounting, const TableAngles& table);

}  // namespace mgtd::daemon::plan
