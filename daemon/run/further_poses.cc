// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/further_poses.h"

#include <algorithm>

#include "daemon/plan/plan_from_list.h"

namespace mgtd::daemon::run {

LooksLeft left_after(const std::vector<RunJudgement>& judgements, double minutes) {
  for (const RunJudgement& judgement : judgements) minutes -= judgement.minutes;
  return {.minutes = minutes, .looks = kMostJudgements - static_cast<int>(judgements.size()) - 1};
}

FurtherPoses further_poses(const Result<NextPoses>& next, const plan::RunPlan& plan,
                           const drivers::TableLimits& limits) {
  if (!next)
    return {.judgement = {.poses = static_cast<int>(plan.poses.size()),
                          .found = "the run could not be judged",
                          .next = next.error().text()},
            .poses = {}};
  FurtherPoses out{.judgement = next->judgement, .poses = {}};
  if (next->poses.empty()) return out;
  int last = 0;
  for (const plan::PlannedPose& pose : plan.poses) last = std::max(last, pose.number);
  RunRequest request;
  request.list = "what would settle it";
  request.poses = next->poses;
  for (RequestedPose& pose : request.poses) pose.number = ++last;
  const auto listed = plan::plan_from_list(request, plan.options, limits);
  if (listed) {
    out.poses = listed->poses;
  } else {
    out.judgement.next += "; not on this table: " + listed.error().text();
    out.judgement.minutes = 0;
  }
  return out;
}

}  // namespace mgtd::daemon::run
