// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_summary.h"
#include "calib/fit/joint/fit_noise.h"
#include "calib/fit/joint/outliers.h"

/// The robust fit solves, estimates the weights and leaves readings out, in turn, until nothing changes.
///
/// It starts from all poses; where that, or the readings alone, show that some poses are far from the others,
/// it starts once more from the poses that agree with each other (consensus.h), and keeps the more likely
/// result. Where the readings kept do not agree down to the noise of the dwells, it also leaves out stretches
/// that are shifted against the rest (stretch_scan.h) and a sensor that is off by little in scattered poses.
namespace mgtd::calib::fit::joint {

struct RobustFit {
  JointSolution solution;
  PoseResiduals residuals;
  Outliers outliers;
  FitNoise noise;
  JointState start;  ///< where the solver began
  Termination termination{Termination::converged};
  int rounds{0}, iterations{0};
};

/// Weighs `problem` and leaves out of it as it goes. `start` may be an error: then only the poses that agree
/// can help. `unsettled` tells that no more went wrong than that nothing settled.
[[nodiscard]] Result<RobustFit> robust_fit(JointProblem& problem, Result<JointState> start, double f_nT,
                                           const FitNoise& noise, double most_left_out, bool& unsettled);

/// From the end of a fit of these readings: what contradicts there is left out before anything moves.
[[nodiscard]] Result<RobustFit> robust_fit_from(JointProblem& problem, JointState warm_start,
                                                const FitNoise& noise, double most_left_out, bool& unsettled);

}  // namespace mgtd::calib::fit::joint
