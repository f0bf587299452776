// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <math.h>  // pchip.hpp of Boost 1.74 calls ::isnan

#include <boost/math/interpolators/pchip.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "proto/pose.h"

/// A TablePath tells where the table was between the readings of its path.
///
/// Each angle follows a monotone cubic through its readings (Fritsch and Carlson 1980; Boost.Math's pchip):
/// exact at constant velocity, and where an axis begins to brake with an acceleration A the error is below
/// A dt²/8 for readings dt apart. At its last reading the table rests.
///
/// Azimuth and roll are continued past ±180 degrees. Where an angle jumps from one reading to the next (the
/// angles of an attitude near ±90 degrees of pitch do), and among fewer than four readings, nothing is known
/// between them.
namespace mgtd::calib::poses {

class TablePath {
 public:
  /// `readings` in order of time, from one dwell to the next.
  explicit TablePath(std::span<const PathPoint> readings);

  /// None outside the readings and where nothing is known between them.
  [[nodiscard]] std::optional<TableAngles> at(double t_s) const;

 private:
  using Curve = boost::math::interpolators::pchip<std::vector<double>>;
  struct Stretch {  ///< of readings without a jump
    double begin_s, end_s;
    Curve azimuth_rad, pitch_rad, roll_rad;
  };

  void add(std::span<const PathPoint> stretch);

  std::vector<Stretch> stretches_;
};

}  // namespace mgtd::calib::poses
