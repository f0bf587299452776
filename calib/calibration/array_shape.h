// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

/// An ArrayShape says in how many directions the sensors of an array stand apart: whether they are at one
/// place, on a line, in a plane or in space.
///
/// This alone decides what an array can tell of a gradient. With s_i = r_i - c, c the centroid and
/// size = max |s_i|:
///     one place   size <= kOnePlace_m
///     on a line   every s_i is within kNegligible * size of the line through c along the longest principal
///                 axis of the s_i
///     in a plane  the same of the plane through c along the two longest principal axes
///     in space    otherwise
/// The limits are those of a measurement, not of the computer's digits. The magnetic centre of a fluxgate is
/// known to tenths of a millimetre, on arrays of some decimetres: a thousandth of the size. What stands that
/// little off a line has no lever arm that anybody knows, and a derivative along it would have a thousand
/// times the noise of one along the line. A line is then taken to be exact. In a linear field this moves no
/// reading by more than |G| times `neglected_m`.
namespace mgtd::calib::calibration {

inline constexpr double kOnePlace_m = 1e-6;
inline constexpr double kNegligible = 1e-3;

struct ArrayShape {
  Eigen::Vector3d centroid_P_m;
  double size_m{0};  ///< largest distance from the centroid
  /// Orthonormal columns: the directions in which the sensors stand apart. Of a line the one column has its
  /// first component that is not zero positive, and is exactly an axis where it is one within rounding.
  Eigen::Matrix3Xd span_P;
  /// s_i, one column each; zero where all sensors are at one place, and on the line where they are on a line.
  Eigen::Matrix3Xd offsets_P_m;
  double neglected_m{0};  ///< how far a sensor stands off that place or line at most

  /// 0 one place, 1 line, 2 plane, 3 space
  [[nodiscard]] int dimension() const { return static_cast<int>(span_P.cols()); }
  /// Whether the sensors stand apart along this unit vector, so that the derivative along it is a difference
  /// of readings.
  [[nodiscard]] bool spans(const Eigen::Vector3d& direction_P) const;
};

/// Of one place at least; all places are finite.
[[nodiscard]] ArrayShape shape_of(const Eigen::Matrix3Xd& places_P_m);

}  // namespace mgtd::calib::calibration
