// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_phase.h"

namespace mgtd::daemon::run {
namespace {

struct Shown {
  RunState operator()(const phase::Preflighting&) const { return RunState::preflight; }
  RunState operator()(const phase::Homing&) const { return RunState::homing; }
  RunState operator()(const phase::Asking&) const { return RunState::asking; }
  RunState operator()(const phase::Approaching&) const { return RunState::moving; }
  RunState operator()(const phase::Moving& moving) const {
    return moving.settle.stopped() ? RunState::settling : RunState::moving;
  }
  RunState operator()(const phase::Dwelling&) const { return RunState::dwelling; }
  RunState operator()(const phase::Storing&) const { return RunState::dwelling; }
  RunState operator()(const phase::Suspended&) const { return RunState::suspended; }
  RunState operator()(const phase::Paused&) const { return RunState::paused; }
  RunState operator()(const phase::Waiting&) const { return RunState::paused; }
  RunState operator()(const phase::Judging&) const { return RunState::solving; }
  RunState operator()(const phase::Solving&) const { return RunState::solving; }
  RunState operator()(const phase::Proposing&) const { return RunState::solving; }
  RunState operator()(const phase::Stopping&) const { return RunState::aborting; }
  RunState operator()(const phase::Ended& ended) const { return ended.state; }
};

}  // namespace

RunState state_of(const Phase& phase) { return std::visit(Shown{}, phase); }

bool is_measuring(const Phase& phase) {
  return !std::holds_alternative<phase::Paused>(phase) && !std::holds_alternative<phase::Judging>(phase) &&
         !std::holds_alternative<phase::Solving>(phase) && !std::holds_alternative<phase::Proposing>(phase) &&
         !std::holds_alternative<phase::Stopping>(phase) && !std::holds_alternative<phase::Ended>(phase);
}

}  // namespace mgtd::daemon::run
