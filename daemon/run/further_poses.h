// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "daemon/run/judge_run.h"
#include "daemon/run/run_events.h"
#include "drivers/device.h"

/// These functions say how long a run that goes on until it is explained may still take, and turn the poses
/// that a judgement asks for into a plan for its table.
namespace mgtd::daemon::run {

struct LooksLeft {
  double minutes{0};
  int looks{0};  ///< after the one that is due
};
/// Of so many minutes beside the plan, after these judgements.
[[nodiscard]] LooksLeft left_after(const std::vector<RunJudgement>& judgements, double minutes);

/// Behind `plan`, with numbers of their own. What this table cannot take, and a run that could not be judged,
/// have no poses; the judgement says why.
[[nodiscard]] FurtherPoses further_poses(const Result<NextPoses>& next, const plan::RunPlan& plan,
                                         const drivers::TableLimits& limits);

}  // namespace mgtd::daemon::run
