// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "calib/calibration/tensor.h"

/// Offsets that wander: the slow noise of a fluxgate, which lasts from one pose to the next.
///
/// Over a run of length T the offset of channel c has the expansion
///
///     o(t) = sum_j z_j sqrt(2) cos(j pi (t - t0) / T),   z_j independent, normal,
///
///     walk     sd of z_j = a_c sqrt(T) / (j pi):  var[o(t) - o(s)] = a_c^2 |t - s|, exactly (Karhunen-Loeve)
///     flicker  sd of z_j = a_c / sqrt(j):         one-sided spectral density a_c^2 / f; a term has the
///                                                 power of the band 1 / (2 T) about its frequency j / (2 T)
///
/// Its mean over the run is the offset of the model. The first kWanderingTerms tell how far an offset
/// wanders. Sizes a_c in nT per root hour (walk) or in nT/sqrt(Hz) at 1 Hz (flicker), times in hours. It is
/// noise: no calibration holds it.
namespace mgtd::calib::fit::joint {

inline constexpr int kWanderingTerms = 16;
using WanderingRates = sensor::FieldVector;

enum class SlowSpectrum { walk, flicker };

/// The terms of an offset of unit size over one run.
class WanderingTerms {
 public:
  /// From the first pose to the last. `poses`: how many; flicker that is faster than they follow each other
  /// is part of the noise of each.
  WanderingTerms(double from_h, double to_h, SlowSpectrum spectrum = SlowSpectrum::walk,
                 std::size_t poses = 0)
      : from_h_(from_h), length_h_(to_h - from_h), spectrum_(spectrum), poses_(poses) {}
  /// False where the poses have no time, or one.
  [[nodiscard]] bool any() const { return length_h_ > 0; }
  /// sd(z_j) sqrt(2) cos(j pi (t - t0) / T), j from 1, nT.
  [[nodiscard]] Eigen::Matrix<double, kWanderingTerms, 1> at(double t_h) const;
  [[nodiscard]] double to_h() const { return from_h_ + length_h_; }
  /// Of the offset less its mean over the run, at either end, nT^2: T / 3 for a walk; for flicker the sum of
  /// 2/j up to the number of poses, or up to kWanderingTerms where there are fewer.
  [[nodiscard]] double variance_at_end() const;
  /// Of the terms beyond the last, mean over the run, nT^2.
  [[nodiscard]] double variance_beyond() const;

 private:
  double from_h_, length_h_;
  SlowSpectrum spectrum_;
  std::size_t poses_;
};

}  // namespace mgtd::calib::fit::joint
