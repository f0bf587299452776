// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/run/run_fsm.h"

/// CurrentRun holds the run that is under way, or the last one, and puts the events in order that reach it:
/// what happens while its actions are carried out reaches it after them. One run at a time. Pure: actions go
/// to the owner.
namespace mgtd::daemon::run {

class CurrentRun {
 public:
  using CarryOut = std::function<void(const Action& action, Stamp now)>;
  explicit CurrentRun(CarryOut carry_out) : carry_out_(std::move(carry_out)) {}
  CurrentRun(const CurrentRun&) = delete;
  CurrentRun& operator=(const CurrentRun&) = delete;

  /// Takes the place of the one before.
  void begin(RunConfig config, plan::RunPlan plan, Stamp now,
             const std::optional<EarlierLife>& earlier = std::nullopt);
  /// Forgets the last one.
  void drop() { fsm_.reset(); }

  /// Nothing happens without an active run.
  void feed(const Event& event, Stamp now);
  /// The answer to an action: reaches the run with the event under way, or with the next one.
  void answer(Event event) { waiting_.push_back(std::move(event)); }

  [[nodiscard]] bool active() const { return fsm_ != nullptr && !fsm_->ended(); }
  /// Null before the first one.
  [[nodiscard]] const RunFsm* fsm() const { return fsm_.get(); }

 private:
  void step(const Event& event, Stamp now);

  CarryOut carry_out_;
  std::unique_ptr<RunFsm> fsm_;
  std::vector<Event> waiting_;
  bool stepping_{false};
};

}  // namespace mgtd::daemon::run
