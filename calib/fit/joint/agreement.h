// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/calibration/calibration.h"
#include "calib/fit/joint/joint_fit.h"

/// Agreement says whether the readings that a joint fit kept agree with each other. A gross reading that
/// bends the calibration towards itself shows in one of three places: a few residuals far above most, one
/// pose on which the result rests, or poses that were left out and are missed by more than those that were
/// fitted.
namespace mgtd::calib::fit::joint {

/// Ratio of the residual's rms to the rms that its median implies: noise with heavy tails (Student's t with
/// three degrees of freedom) reaches 1.6, a smooth law that the model misses kTailsOfLaw. Above kMaxTails a
/// few readings are far off.
inline constexpr double kTailsOfLaw = 2;
inline constexpr double kMaxTails = 3;

/// How far the readings that were kept scatter.
struct Scatter {
  double residual_nT{0};  ///< root of the mean square
  double typical_nT{0};   ///< the same from the median of each axis, as Gaussian noise would have it
  /// A few are far from most, and bend the others.
  [[nodiscard]] bool few_far_off() const;
};

[[nodiscard]] Scatter scatter_of(const JointFit& fit);

struct Agreement {
  Scatter scatter;
  int poses{0};
  std::optional<double> held_out_nT;  ///< FitReport::held_out_residual_nT; of few poses it tells nothing
  double fitted_nT{0};                ///< FitReport::residual_nT, which that is held against
  int pose{0};                        ///< the pose without which the calibration would move most
  /// By so many of its own standard deviations, root of the mean square over the unknowns; counts only where
  /// it is several times what the noise of that pose can do.
  double moved{0};
};

/// `S`: information of the fixed block at the end of the fit.
[[nodiscard]] Agreement agreement(const JointFit& fit, const Eigen::MatrixXd& S, double fitted_nT,
                                  std::optional<double> held_out_nT);

}  // namespace mgtd::calib::fit::joint
