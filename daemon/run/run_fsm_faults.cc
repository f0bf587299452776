// SPDX-License-Identifier: Apache-2.0
// What interrupts a run: the operator, a fault, a device that is lost. Whatever it is, the table stops, as
// soon as it can be reached.
#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "daemon/run/run_fsm.h"

namespace mgtd::daemon {
namespace {

constexpr std::string_view kUnreachable = "the table cannot be reached and may still move";

}  // namespace

Result<void> RunFsm::possible(Request request) const {
  const auto refuse = [](std::string message, std::string remedy) {
    return fail(ErrorCode::state, std::move(message), std::move(remedy));
  };
  if (phase_ == Phase::ended) {
    if (request == Request::abort) return {};
    return refuse(fmt::format("the run has ended: {}", name(final_)), "start a new one");
  }
  switch (request) {
    case Request::abort:
      return {};
    case Request::pause:
      if (phase_ == Phase::paused) return refuse("the run is paused already", "resume or abort it");
      if (!measuring()) return refuse("all poses are measured and the table is at rest", "wait, or abort");
      return {};
    case Request::resume:
      if (asks_for_deed()) return {};
      if (phase_ != Phase::paused) return refuse("the run is not paused", "");
      if (own_.another()) return refuse(own_.measured(), own_.remedy());
      if (!lost_.empty())
        return refuse(fmt::format("{} is not connected: {}", lost_.begin()->first, lost_.begin()->second),
                      "reconnect it, then resume");
      return {};
    case Request::redo:
      if (!measuring() && phase_ != Phase::paused) return refuse("all poses are measured", "wait, or abort");
      if (unanswered_) return refuse("a pose is being stored", "ask again in a moment");
      if (mounted_ || scales_of_ || forgotten_ || (config_.by_hand && last_stored_)) return {};
      return refuse("nothing was entered by hand yet that could be entered again", "");
    case Request::finish:
      if (!measuring() && phase_ != Phase::paused) return refuse("all poses are measured", "wait, or abort");
      if (progress_.done() < config_.fewest_poses)
        return refuse(fmt::format("{} poses are measured, and a calibration needs at least {}",
                                  progress_.done(), config_.fewest_poses),
                      "let it go on, or end it without a calibration: mgt run abort");
      return {};
  }
  return refuse("no such request", "");
}

void RunFsm::on(const Request& request) {
  if (!possible(request)) return;
  act(Record{fmt::format("the operator says: {}", name(request))});
  switch (request) {
    case Request::abort:
      return abort();
    case Request::pause:
      return pause();
    case Request::resume:
      if (asks_for_deed()) return carried_out();
      attempt_ = 0;
      forgotten_.reset();
      return go_on();
    case Request::finish:
      return finish_early();
    case Request::redo:
      return redo();
  }
}

void RunFsm::pause() {
  hold(progress_.next() ? "paused by the operator; the pose under way will be measured again"
                        : "paused by the operator");
}

/// What is being measured is kept, what is only under way is not.
void RunFsm::finish_early() {
  enough_ = true;
  if (phase_ == Phase::dwelling || phase_ == Phase::storing) return;
  if (phase_ != Phase::paused && !measuring()) return;
  act(StopTable{});
  go_on();
}

void RunFsm::hold(const std::string& message) {
  act(StopTable{});
  flush_path();
  level_nT_.reset();  // whoever goes on takes the field as it is
  disturbed_since_.reset();
  forgotten_ = std::exchange(scales_of_, std::nullopt);  // a hand may be at the table meanwhile
  enter(Phase::paused, message);
  act(Record{"paused: " + message});
}

void RunFsm::abort() {
  if (phase_ == Phase::stopping) return;
  if (phase_ == Phase::solving) act(CancelSolve{});
  act(StopTable{});
  proposed_.clear();
  enter(Phase::stopping, "aborting: stopping the table");
}

void RunFsm::advance_stopping() {
  const bool rests = table_ && table_->arrival.mono > entered_ && !table_->moving;
  if (rests) {
    finish(RunState::aborted, "aborted by the operator, the table is at rest; " + kept());
  } else if (lost_.contains("table") || timed_out(config_.stop_max_s)) {
    finish(
        RunState::aborted,
        fmt::format("aborted by the operator, but {}: look at it; {}",
                    lost_.contains("table") ? kUnreachable : "the table has not reported that it is at rest",
                    kept()));
  }
}

void RunFsm::on(const DeviceLost& lost) {
  if (lost.device == "table") {
    homed_ = false;
    table_.reset();
    rests_.reset();
  }
  lost_.insert_or_assign(lost.device, lost.why);
  changed_ = true;
  act(Record{fmt::format("{} is lost: {}{}", lost.device, lost.why,
                         lost.device == "table" ? fmt::format("; {}", kUnreachable) : "")});
  if (phase_ == Phase::preflight) {  // it reports on links itself
    LinkHealth health;
    health.detail = lost.why;
    preflight_.add(lost.device, health);
    return;
  }
  if (!measuring() || phase_ == Phase::waiting) return;
  act(StopTable{});
  enter(Phase::waiting, "waiting for " + lost.device);
}

void RunFsm::on(const DeviceBack& back) {
  if (lost_.erase(back.device) == 0) return;
  act(Record{back.device + " is back"});
  changed_ = true;
}

std::string RunFsm::in_status() const {
  const bool unreachable = lost_.contains("table");
  if (phase_ == Phase::waiting && !lost_.empty()) {
    std::string who;
    for (const auto& [device, why] : lost_)
      who += fmt::format("{}{} is lost ({})", who.empty() ? "" : ", ", device, why);
    return fmt::format("{}; {}, waiting up to {:.0f} s, then the pose is measured again", who,
                       unreachable ? kUnreachable : "the table is stopped", config_.lost_max_s);
  }
  const bool matters = unreachable && phase_ != Phase::preflight && (measuring() || phase_ == Phase::paused);
  return matters ? fmt::format("{}; {}", message_, kUnreachable) : message_;
}

void RunFsm::on(const DeviceFaulted& faulted) {
  const std::string what = fmt::format("{}: {}{}{}", faulted.device, faulted.fault.what,
                                       faulted.fault.remedy.empty() ? "" : "; ", faulted.fault.remedy);
  const bool already_known = lost_.contains(faulted.device);
  if (measuring() && !already_known) {
    if (phase_ == Phase::preflight && progress_.done() == 0)
      finish(RunState::failed, what);
    else
      hold(what);
    return;
  }
  act(Record{what});
}

}  // namespace mgtd::daemon
