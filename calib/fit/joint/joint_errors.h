// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/fit/error_summary.h"
#include "calib/fit/fit_report.h"
#include "calib/fit/joint/joint_fit.h"

/// JointErrors says how far corrected readings are from what they should be, in the sample and out of it.
namespace mgtd::calib::fit::joint {

struct JointErrors {
  /// |b| against each pose's own F, and the tensor; effects of the site taken out of both. A sensor one of
  /// whose readings the fit left out does not count in that pose, nor does the tensor of it.
  ErrorSummary summary;
  double residual_nT{0};  ///< PoseResiduals::residual_nT
};

/// Whether the fixed block was fitted to these very poses, or is given: fitted to others, or the truth.
enum class FixedBlock { fitted, given };

/// By what the fit left out.
[[nodiscard]] Counted counted(const JointProblem& problem);

/// Errors of these poses with a fixed block as it stands. The nuisances in `state` are those of `problem`'s
/// poses.
[[nodiscard]] JointErrors joint_errors(const JointProblem& problem, const JointState& state,
                                       FixedBlock block);

/// With the normal equations of the fit, undamped. Folds contiguous in time. The calibration of each fold is
/// fitted to the others alone; of a pose left out only its own field (and, where the table's angles are
/// known, attitude) is refitted. Empty when a fold cannot be fitted without its poses.
[[nodiscard]] std::optional<JointErrors> held_out_errors(const JointFit& fit, const Reduced& equations);

}  // namespace mgtd::calib::fit::joint
