// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/fit/method_choice/fit.h"
#include "daemon/store/pose_source.h"

namespace mgtd::cli {

/// Formulas of the run file become candidates beside the library when its poses have their columns and the
/// model lacks them. Those that were suggested by these very poses are named on stderr.
[[nodiscard]] std::vector<calib::CandidateEffect> formulas_of(const daemon::PoseSource& source,
                                                              const calib::FitOptions& options);

}  // namespace mgtd::cli
