// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/fit/method_choice/fit.h"
#include "tests/support/paper_rigs.h"

namespace mgtd::testing {

/// This fits one simulated run by every method and gives the errors on its own poses, as the paper counts
/// them.
struct RunErrors {
  calib::fit::ErrorSummary before, step1, two_step, joint;
  calib::fit::ErrorSummary floor;  ///< that the true parameters leave
  std::optional<calib::fit::ErrorSummary> simplified, odd, even;
  calib::fit::FitReport two_step_report, joint_report;
};

[[nodiscard]] RunErrors run_errors(const RigTruth& rig, const PoseTable& table,
                                   const calib::fit::FitOptions& options);

/// Root of the mean square of several runs.
[[nodiscard]] RunErrors mean_of(const std::vector<RunErrors>& runs);

}  // namespace mgtd::testing
