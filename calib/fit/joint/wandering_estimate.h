// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/fit/joint/slow_sums.h"

/// A WanderingEstimate says which offsets wander, and how fast, as the residual of a joint fit shows it
/// (wandering.h).
///
/// With everything else of the model projected out, the residual r has covariance sigma^2 (I + sum_c theta_c
/// U_c U_c'), U_c the terms of channel c for a walk or flicker of unit size. The sizes are those of the
/// largest restricted likelihood (REML), in which sigma^2 is profiled: what a dwell says of the noise does
/// not enter. Channels of one place differ little in size: each is weighed with the size of its place. The
/// evidence is 2 ln of the odds against white noise, the likelihood averaged over the size,
/// less 2 ln of the number of places that were asked (all channels, one of four sensors, one of twelve
/// channels).
///
/// Walk and flicker are told apart by their evidence.
///
/// A law that the model lacks and that follows time makes an offset wander too. This says how well wandering
/// describes the residual, never that nothing better does: see criticism/tests/wandering_alternative.h.
namespace mgtd::calib::fit::joint {

/// The restricted likelihood of relative variances theta_c = (size_c / sigma)^2.
class SlowLikelihood {
 public:
  explicit SlowLikelihood(SlowSums sums) : sums_(std::move(sums)) {}
  [[nodiscard]] const SlowSums& sums() const { return sums_; }
  /// -2 ln L, up to a constant.
  [[nodiscard]] double deviance(const Channels& theta) const;
  /// r' V^-1 r with V = I + sum theta_c U_c U_c'.
  [[nodiscard]] double quadratic(const Channels& theta) const;
  /// sigma^2 at theta.
  [[nodiscard]] double noise_variance(const Channels& theta) const;
  /// Steps uphill over the channels that wander already (minorise-maximise: never downhill). The start counts
  /// as `alike` squares more of each channel: ln theta has the prior -alike/2 (ln theta + start / theta).
  void climb(Channels& theta, int steps, const Channels& alike) const;

 private:
  SlowSums sums_;
};

struct WanderingEstimate {
  SlowSpectrum spectrum{SlowSpectrum::walk};
  WanderingRates size, sd;           ///< by channel (wandering.h); empty where nothing wanders
  double evidence{0};                ///< 2 ln odds against white noise, places priced
  double noise_scale2{1};            ///< variance of the white noise over that of the weights, all channels
  std::vector<std::string> where{};  ///< "all", or those that wander: "s2", "s3.z"
  [[nodiscard]] bool any() const { return evidence > 0; }
};

/// Evidence from which offsets are said to wander: odds of a hundred.
inline constexpr double kWanderingEvidence = 9.2;
[[nodiscard]] WanderingEstimate estimate_wandering(const SlowLikelihood& likelihood);

/// 2 ln of the odds of channels with white noise of their own against the same factor for all: a channel that
/// is noisier than the others, or follows a law without time, looks like one that wanders. Less than this no
/// walk is worth.
[[nodiscard]] double unequal_noise_evidence(const JointFit& fit);

/// What wanders in a fit and is worth saying, as the spectrum with the larger evidence has it:
/// estimate_wandering() against unequal_noise_evidence().
[[nodiscard]] WanderingEstimate wandering_of(const JointFit& fit, const Reduced& equations,
                                             const SlowCosines& cosines);

}  // namespace mgtd::calib::fit::joint
