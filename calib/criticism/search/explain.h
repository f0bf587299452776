// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/criticism/search/explain_options.h"
#include "calib/criticism/search/explain_report.h"

/// explain() finds which physical effect is missing from the model of a run. It gives the evidence, the
/// alternatives, and what the run cannot tell.
///
/// Three tiers, each with its own share of one chance in a hundred of a false alarm: named effects (score
/// test, p calibrated by draws), generic maps, and the size of the residual where the noise is known. The
/// winner is added, everything is fitted again, and the new residual is tested, until nothing stands out.
///
///     PASS       nothing stands out; the smallest effects that would have been seen stand beside it
///     EXPLAINED  what is named, one effect or several, accounts for all of it, and no other could
///     AMBIGUOUS  several could, and these poses do not tell them apart
///     PARTIAL    effects were found and something remains
///     UNKNOWN    something is there, and nothing in the library looks like it
///     BAD-DATA   too many poses that contradict all others, or a residual smaller than its noise
///
/// A name is a hypothesis about the cause; what is measured is that the residual behaves like it.
namespace mgtd::calib::criticism::search {

[[nodiscard]] Result<ExplainReport> explain(const PoseTable& table, const ExplainOptions& options);

}  // namespace mgtd::calib::criticism::search
