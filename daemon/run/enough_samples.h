// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "daemon/plan/run_plan.h"
#include "daemon/run/run_config.h"
#include "proto/error.h"

/// enough_samples() says whether the rate of the stream gives a run enough samples to work with.
namespace mgtd::daemon::run {

/// Refuses a plan with a dwell that cannot hold kFewestInDwell epochs, and a rate at which the window of
/// Settle does not end before its max_s.
[[nodiscard]] Result<void> enough_samples(const plan::RunPlan& plan, const RunConfig& config);

}  // namespace mgtd::daemon::run
