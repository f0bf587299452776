// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_report.h"
#include "calib/fit/joint/joint_fit.h"
#include "proto/fit_so_far.h"

/// AccuracySoFar says during a run how accurate a calibration from the poses measured so far would be.
namespace mgtd::calib::fit::joint {

struct AccuracySoFar {
  int poses{0};
  Gradient tensor_sd_nT_per_m;  ///< by the calibration alone, rms over all attitudes
  FitSoFar fit;
  JointState state;  ///< where to start when the next pose is there

  /// The component that is known worst.
  [[nodiscard]] double worst_nT_per_m() const;
};

/// With the covariance of the parameters of so many sensors, which stand first in it.
[[nodiscard]] FitSoFar fit_so_far(const Eigen::MatrixXd& covariance, std::size_t sensors, double residual_nT);

/// Joint fit from `warm_start` (null: from nothing). Refuses while the poses do not determine the parameters:
/// too few, or about one axis so far.
[[nodiscard]] Result<AccuracySoFar> accuracy_so_far(const PoseTable& table, const FitOptions& options,
                                                    const JointState* warm_start);

}  // namespace mgtd::calib::fit::joint
