// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/fit/fit.h"
#include "calib/fit/joint_fit.h"

/// How far corrected readings are from what they should be, in the sample and out of it.
namespace mgtd::calib {

struct JointErrors {
  ErrorSummary
      summary;  ///< |b| against each pose's own F, and the tensor; effects of the site taken out of both
  double residual_rms_nT{0};  ///< raw readings against prediction, each pose with its own best field
};

/// Errors of these poses with a fixed block as it stands. The nuisances in `state` are those of `problem`'s
/// poses.
[[nodiscard]] JointErrors joint_errors(const JointProblem& problem, const JointState& state);

/// Folds contiguous in time. The calibration of each fold is fitted to the others and frozen; of a pose left
/// out only its own field (and, where the table's angles are known, attitude) is refitted. Empty when a fold
/// cannot be fitted without its poses.
[[nodiscard]] std::optional<JointErrors> held_out_errors(const JointFit& fit);

}  // namespace mgtd::calib
