// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/joint/joint_problem.h"

/// sample_correlation() finds how far the noise of neighbouring poses is correlated, for recordings of single
/// samples, which a sensor's bandwidth and 1/f noise make alike.
///
/// Residuals of pose k with its nuisances fitted are e_k = M_k n_k, M_k = I - N (N'N + Lambda)^-1 N', noise
/// in its own standard deviations. With one correlation r from pose to pose in every channel,
///     r = sum e_k . e_(k-1) / sum tr M_k M_(k-1),
/// in the order of time, good to (sum tr (M_k M_(k-1))^2)^(1/2) over the same sum. First-order autoregressive
/// noise makes n samples worth n (1 - r)/(1 + r) where the sensor turns more slowly than the noise changes.
/// What the fit of the fixed block takes is not corrected for: a share of its unknowns over the poses.
namespace mgtd::calib::fit::joint {

struct SampleCorrelation {
  double r{0};
  double sd{1};  ///< of r, where the noise is not correlated
  /// 0 where r is within three of its standard deviations of nothing.
  [[nodiscard]] double seen() const { return r > 3 * sd ? r : 0; }
  /// Samples that count as one.
  [[nodiscard]] double samples_per_effective() const { return (1 + seen()) / (1 - seen()); }
};

/// Largest r that is reported.
inline constexpr double kMostCorrelated = 0.99;

[[nodiscard]] SampleCorrelation sample_correlation(const JointProblem& problem, const JointState& state);

}  // namespace mgtd::calib::fit::joint
