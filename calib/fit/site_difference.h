// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/pose.h"

/// The site difference is what a scalar magnetometer at the array reads more than a vector reference beside
/// the table, f_nT - |r|. It is a constant, since a storm moves both alike; its mean over the poses that have
/// both fills f_nT in for the poses that have the vector alone:
///
///     F_k = |r_k| + D,   D = mean(f - |r|),   sd of one pose: the scatter of f - |r|, no less than ref_sd_nT
///
/// The error of D is common to all poses filled in. Differences that are gross, further from the median than
/// five of their robust standard deviations and of the stated one, do not count.
namespace mgtd::calib::fit {

struct SiteDifference {
  double mean_nT{0};     ///< D
  double scatter_nT{0};  ///< standard deviation of one difference; 0 of fewer than two
  double sd_nT{0};       ///< of D: the scatter, no less than the stated uncertainties, over root of the poses
  int poses{0};          ///< that have both and are not gross; 0: nothing is known of D

  [[nodiscard]] bool known() const { return poses > 0; }
};

/// Over all poses that have table angles, f_nT and the vector.
[[nodiscard]] SiteDifference site_difference(const PoseTable& table);

struct TotalField {
  double f_nT{0}, sd_nT{0};
};

/// Stated uncertainty of each component of the vector reference; kDefaultScalarSd_nT where none is.
[[nodiscard]] double reference_sd_nT(const Pose& pose);
/// Stated uncertainty of f_nT, by the same rule.
[[nodiscard]] double scalar_sd_nT(const Pose& pose);

/// Total field of a pose that has the vector, at the array: f_nT where it is there, else |r| + D.
[[nodiscard]] TotalField total_field(const Pose& pose, const SiteDifference& difference);

}  // namespace mgtd::calib::fit
