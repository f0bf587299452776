// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/fit/methods/fit.h"
#include "daemon/store/pose_source.h"

namespace mgtd::cli {

/// Formulas of the run file that its poses can feed and that are not in the model, as suspects beside the
/// library. Says on stderr which of them were thought of on these very poses.
[[nodiscard]] std::vector<calib::CandidateEffect> formulas_of(const daemon::PoseSource& source,
                                                              const calib::FitOptions& options);

}  // namespace mgtd::cli
