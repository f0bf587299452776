// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/current_run.h"

namespace mgtd::daemon::run {

void CurrentRun::begin(RunConfig config, plan::RunPlan plan, Stamp now,
                       const std::optional<EarlierLife>& earlier) {
  waiting_.clear();
  fsm_ = std::make_unique<RunFsm>(std::move(config), std::move(plan), now, earlier);
  feed(Tick{}, now);
}

void CurrentRun::step(const Event& event, Stamp now) {
  for (const Action& action : fsm_->step(event, now)) carry_out_(action, now);
}

void CurrentRun::feed(const Event& event, Stamp now) {
  if (!active()) return;
  if (stepping_) return waiting_.push_back(event);
  stepping_ = true;
  step(event, now);
  while (!waiting_.empty()) {
    const std::vector<Event> waiting = std::exchange(waiting_, {});
    for (const Event& next : waiting) step(next, now);
  }
  stepping_ = false;
}

}  // namespace mgtd::daemon::run
