// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/calibration/tensor.h"

/// Offsets that wander: the slow noise of a fluxgate, which lasts from one pose to the next.
///
/// The offset of channel c is a random walk with rate a_c: var[o(t) - o(s)] = a_c^2 |t - s|. Its mean over a
/// run of length T is the offset of the model. What remains has the Karhunen-Loeve expansion
///
///     o(t) = sum_j z_j sqrt(2) cos(j pi (t - t0) / T),   z_j independent, normal, sd a_c sqrt(T) / (j pi).
///
/// The first kWanderingTerms tell how fast an offset wanders. Rates in nT per root hour, times in hours. It
/// is noise: no calibration holds it.
namespace mgtd::calib::fit::joint {

inline constexpr int kWanderingTerms = 16;
using WanderingRates = sensor::FieldVector;

/// The terms of a walk of 1 nT per root hour over one run.
class WanderingTerms {
 public:
  WanderingTerms(double from_h, double to_h) : from_h_(from_h), length_h_(to_h - from_h) {}
  /// False where the poses have no time, or one.
  [[nodiscard]] bool any() const { return length_h_ > 0; }
  /// sd(z_j) sqrt(2) cos(j pi (t - t0) / T), j from 1, nT.
  [[nodiscard]] Eigen::Matrix<double, kWanderingTerms, 1> at(double t_h) const;
  [[nodiscard]] double to_h() const { return from_h_ + length_h_; }
  /// Of the walk less its mean over the run, at either end, with all terms: T / 3, nT^2.
  [[nodiscard]] double variance_at_end() const { return length_h_ / 3; }

 private:
  double from_h_, length_h_;
};

}  // namespace mgtd::calib::fit::joint
