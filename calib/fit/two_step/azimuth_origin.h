// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "calib/fit/azimuth_gauge.h"
#include "calib/fit/two_step/step2.h"

/// azimuth_origin() fixes the azimuth of the platform frame, which step 2 leaves open. The standard set
/// leaves one turn about Z common to the four sensors: the direction D of the horizontal field in the
/// platform frame at azimuth zero. It is, in this order,
///   - given (the operator's declination),
///   - found from poses that tilt: their table angles T_k say where the field was, T_k B_site = b_k,
///   - set so that the mean gamma of the four sensors is zero.
/// The tensor of a uniform field does not depend on it.
namespace mgtd::calib::fit::two_step {

/// `alignment` has D = 0.
[[nodiscard]] AzimuthOrigin azimuth_origin(const Readings& readings, const Alignment& alignment,
                                           const PerSensor<Eigen::Matrix3Xd>& b_S_nT,
                                           std::optional<double> declination_rad);

/// The same alignment with the field at azimuth zero in the direction D.
void turn_to(Alignment& alignment, double declination_rad);

/// Site frame to platform frame (passive): Rz(azimuth) Ry(pitch) Rx(roll).
[[nodiscard]] Eigen::Matrix3d table_rotation(const TableAngles& angles);

/// The angles are known and turn the platform away from Z by two degrees or more.
[[nodiscard]] bool is_tilted(const std::optional<TableAngles>& angles);

}  // namespace mgtd::calib::fit::two_step
