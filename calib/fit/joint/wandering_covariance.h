// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "calib/fit/joint/wandering_estimate.h"

/// covariance_with_wandering() computes the uncertainty of a joint fit whose offsets wander
/// (wandering_estimate.h says which, and how fast).
namespace mgtd::calib::fit::joint {

/// Covariance of the fixed block of an ordinary fit whose offsets wander, each offset as it is at the end of
/// the run, where the calibration begins to be used. The estimates are those of least squares; with S the
/// information of the fixed block, X its products with the slow terms, D the squares of their sizes and E
/// their covariance with the offsets at the end of the run, in the rows of these,
///     n (sigma^2 S^-1 + S^-1 W S^-1) + (S^-1 X - E) D (S^-1 X - E)' + what the terms do not hold of the
///     offsets at the end + filled_in_error(),
/// n the samples of a recording that count as one (JointFit::samples_per_effective), W what the terms beyond
/// the last, which look white from pose to pose, add to the covariance of the normal equations. How much
/// further an offset wanders after the run is not in it. `equations` and `cosines` as slow_sums() takes them.
/// Empty where S is not positive definite.
[[nodiscard]] std::optional<Eigen::MatrixXd> covariance_with_wandering(const JointFit& fit,
                                                                       const Reduced& equations,
                                                                       const SlowCosines& cosines,
                                                                       const WanderingEstimate& wandering);

}  // namespace mgtd::calib::fit::joint
