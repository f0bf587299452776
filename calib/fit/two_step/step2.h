// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "calib/fit/readings.h"
#include "calib/sensor/step1.h"

/// Step 2 aligns the sensors with the platform frame, from a turn of the level table about platform Z (the
/// standard set).
///
///     P Tz = Bz,   P Tx = Bh cos(D - az),   P Ty = Bh sin(D - az)          (eqs. 16-18)
///
/// P holds the fields of step 1, one row per pose, brought to the mean total field. |Bz| is not given by the
/// table: P u = 1 gives |Bz| = 1/|u| and Tz, which is u/|u| or its opposite. The horizontal rows fix Tx and
/// Ty with their signs, so the sign of Tz decides between a right-handed and a mirrored sensor; it is common
/// to the four (the sign of Bz) and chosen by the majority, by a known inclination, or by the poses that
/// tilt. Here D = 0: the origin of the azimuth is a common turn of all sensors, found elsewhere
/// (azimuth_origin.h).
namespace mgtd::calib::fit::two_step {

struct Alignment {
  PerSensor<Eigen::Matrix3d> R_PS;  ///< nearest orthogonal matrices; determinant -1: mirrored
  double bz_nT{0};                  ///< mean over the sensors, with its sign
  double bh_nT{0};
  double condition{0};  ///< of P, worst sensor
};

/// b_S: the corrected fields of every pose in the sensors' own frames. Only poses marked standard with a
/// known azimuth count. `bz_sign` +1 or -1 when known. Refuses fewer than five such poses, poses
/// that are not level, a turn of less than 90 degrees, and a field within about three degrees of Z or of the
/// horizontal plane, with the condition number.
[[nodiscard]] Result<Alignment> align(const Readings& readings, const PerSensor<Eigen::Matrix3Xd>& b_S_nT,
                                      std::optional<double> bz_sign);

}  // namespace mgtd::calib::fit::two_step
