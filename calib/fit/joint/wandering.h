// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <numbers>

#include "calib/calibration/tensor.h"

/// The offset of a fluxgate wanders: its slow noise lasts from one pose to the next.
///
/// Over a run of length T the offset of channel c, less its mean over the run, has the expansion
///
///     o(t) = sum_j z_j sqrt(2) cos(j pi (t - t0) / T),   z_j normal
///
///     walk     z_j independent, sd a_c sqrt(T) / (j pi): var[o(t) - o(s)] = a_c^2 |t - s|, exactly
///              (Karhunen-Loeve)
///     flicker  one-sided spectral density a_c^2 / f, so var[o(t) - o(s)] = 2 a_c^2 ln|t - s| + const:
///              var z_j is close to a_c^2 / j, the power of the band 1 / (2 T) about the frequency j / (2 T),
///              and 23 % less for j = 1; every second z_j is correlated a little. wandering.cc has the
///              integrals.
///
/// That mean is the offset of the model. The first kWanderingTerms tell how far an offset
/// wanders. Sizes a_c in nT per root hour (walk) or in nT/sqrt(Hz) at 1 Hz (flicker), times in hours. It is
/// noise: no calibration holds it.
namespace mgtd::calib::fit::joint {

inline constexpr int kWanderingTerms = 16;
using WanderingRates = sensor::FieldVector;

enum class SlowSpectrum { walk, flicker };

/// The terms of an offset of unit size over one run.
class WanderingTerms {
 public:
  /// From the first pose to the last. `poses`: how many.
  WanderingTerms(double from_h, double to_h, SlowSpectrum spectrum = SlowSpectrum::walk,
                 std::size_t poses = 0);
  /// False where the poses have no time, or one.
  [[nodiscard]] bool any() const { return length_h_ > 0; }
  /// What independent coefficients of unit variance are multiplied by at a time, nT: L' times the cosines, L
  /// L' the covariance of all z_j. From that of flicker the mean power of the faster terms is taken, which is
  /// part of the white noise from pose to pose.
  [[nodiscard]] Eigen::Matrix<double, kWanderingTerms, 1> at(double t_h) const;
  /// pi (t - t0) / T.
  [[nodiscard]] double phase(double t_h) const { return std::numbers::pi * (t_h - from_h_) / length_h_; }
  /// L: the coefficients z are L times independent ones of unit variance.
  [[nodiscard]] const Eigen::Matrix<double, kWanderingTerms, kWanderingTerms>& factor() const {
    return factor_;
  }
  [[nodiscard]] double to_h() const { return from_h_ + length_h_; }
  /// Covariance of those coefficients with the offset at the end of the run, nT.
  [[nodiscard]] Eigen::Matrix<double, kWanderingTerms, 1> by_end() const;
  /// Of the offset at either end, nT^2: T / 3 for a walk; for flicker 1 - ln(d / T), of its mean over a dwell
  /// d, for which half of the time from pose to pose is taken (of kWanderingTerms poses where there are
  /// fewer).
  [[nodiscard]] double variance_at_end() const;
  /// Of the terms beyond the last, mean over the run, nT^2.
  [[nodiscard]] double variance_beyond() const;

 private:
  double from_h_, length_h_;
  SlowSpectrum spectrum_;
  double poses_;
  Eigen::Matrix<double, kWanderingTerms, kWanderingTerms> factor_ =
      Eigen::Matrix<double, kWanderingTerms, kWanderingTerms>::Zero();  ///< L
};

}  // namespace mgtd::calib::fit::joint
