// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/fit/method_choice/fit.h"
#include "daemon/store/pose_source.h"

namespace mgtd::daemon::cli {

/// Formulas of the run file become candidates beside the library when its poses have their columns and the
/// model lacks them. Those that were suggested by these very poses are named on stderr.
[[nodiscard]] std::vector<calib::criticism::tests::CandidateEffect> formulas_of(
    const store::PoseSource& source, const calib::fit::FitOptions& options);

}  // namespace mgtd::daemon::cli
