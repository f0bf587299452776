// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/units.h"

/// These limits decide which checks a calibration passes, in SI units and radians. No flag changes them: a
/// calibration that was accepted means the same everywhere.
namespace mgtd::calib::fit::checks {

/// Scale factors of an axis. A fluxgate is built to parts in a thousand; a factor of two is another sensor,
/// range or unit.
inline constexpr double kMinScale = 0.5, kMaxScale = 2;
/// Of the angles between the axes of a sensor. Commercial fluxgates stay below one degree.
inline constexpr double kMaxNonOrthogonality_rad = to_rad(15);
/// Volume that a corrected unit of the raw readings takes, zero for the trivial solution in which every
/// reading maps to one field.
inline constexpr double kMinDeterminant = 0.1, kMaxDeterminant = 10;
/// Residual of |b| as a share of the field. No known effect of a working instrument leaves more.
inline constexpr double kMaxResidualShare = 1e-3;
/// Share of the poses that may contradict the others. A robust start finds them while a third is wrong; this
/// is what it is trusted with.
inline constexpr double kMaxBadPoses = 0.25;

/// Disagreement of the tilted poses with the table angles (two-step), in standard deviations of those angles.
inline constexpr double kMaxMisfitSigmas = 5;
/// Difference between the odd and the even half of the standard set (two-step), in standard deviations.
inline constexpr double kMaxHalvesSigmas = 6;

/// Scatter of the attitudes about the table angles (joint), in standard deviations that the operator stated.
inline constexpr double kMaxTableSigmas = 5;
/// The same, at the most: a fit estimates 10 degrees at the most, and what is nearer to that may be anything.
inline constexpr double kMaxTable_rad = to_rad(9);
/// The same, at the least: scales that are read by hand are good to 2 degrees.
inline constexpr double kByHand_rad = to_rad(5);
/// Difference between the direction of the field that was given and the one that was found, in standard
/// deviations.
inline constexpr double kMaxDirectionSigmas = 5;
/// Condition of the information matrix: its square is what double precision has left of ten digits.
inline constexpr double kMaxCondition = 1e6;
/// Angle between a sensor and the nearest whole quarter turns. Half way to the next one, the name of a
/// mounting means nothing.
inline constexpr double kMaxTurn_rad = to_rad(35);

/// Residual of the poses that a fit has not seen over that of those it has.
inline constexpr double kMaxHeldOut = 3;
/// Poses from which on the held-out residual is judged: of fewer, a tenth left out may leave the others too
/// little to be predicted with.
inline constexpr int kEnoughPoses = 40;
/// Shift of the calibration when its most influential pose is taken out, in its own standard deviations.
inline constexpr double kMaxMoved = 1;

/// How far, rms, the sensors may put the attitudes from the table's angles: a few times what the operator
/// says of these angles, but not less than scales read badly by hand reach. The fit estimates how good the
/// angles are, so only a wrong sense or order has to be refused.
[[nodiscard]] double table_limit_rad(double stated_table_sd_rad);

/// Whether the table angles are so much less accurate than the operator stated that the report says so.
[[nodiscard]] bool table_is_rough(double estimated_rad, double stated_rad);

}  // namespace mgtd::calib::fit::checks
