// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/fit/joint/joint_setup.h"
#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/joint/pose_residuals.h"

/// FitNoise holds the noise that weighs a joint fit and is estimated with it: that of the readings from the
/// spreads within the dwells, else from the residuals; that of the table's angles always from what they had
/// to be corrected by.
namespace mgtd::calib::fit::joint {

/// Estimates do not go below: 0.1 pT.
inline constexpr double kNoiseFloor_nT = 1e-4;

struct FitNoise {
  calibration::AxisNoise pose_nT{calibration::AxisNoise::Constant(
      kSensors, 3, kStartNoise_nT)};                  ///< of a pose mean, where no dwell tells it
  std::optional<calibration::AxisNoise> sample_nT{};  ///< of a sample, where the dwells do
  double table_sd_rad{0};
  double noise_inflation{1};  ///< JointOptions::noise_inflation
  /// Beside the dwells' own, nT^2: of the digitiser's step, and what JointOptions adds.
  Channels more_nT2;

  /// Weighs the poses; what was left out or loosened has to be left out or loosened again.
  void apply(JointProblem& problem) const;
  /// Estimates anew from the residuals of a fit; returns whether anything moved enough to fit again.
  bool update(const PoseResiduals& residuals, const JointProblem& problem);
};

/// Weighs, refits the nuisances and estimates in turn while the fixed block stays: a fraction of the cost of
/// a fit for each.
void settle(FitNoise& noise, JointProblem& problem, JointState& state);

/// Noise of a pose mean as it was weighted, rms over the poses.
[[nodiscard]] calibration::AxisNoise assumed_noise(const JointProblem& problem);

}  // namespace mgtd::calib::fit::joint
