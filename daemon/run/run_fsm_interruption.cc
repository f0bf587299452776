// SPDX-License-Identifier: Apache-2.0
// What interrupts a run: the operator, what is set by hand, a field that does not stand still, another
// sensor, a fault, a device that is lost. Whatever it is, the table stops, as soon as it can be reached.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "daemon/acquire/calibrated_with.h"
#include "daemon/run/run_fsm.h"

namespace mgtd::daemon::run {
namespace {

constexpr std::string_view kUnreachable = "the table cannot be reached and may still move";

}  // namespace

Result<void> RunFsm::possible(Request request) const {
  const auto refuse = [](std::string message, std::string remedy) {
    return fail(ErrorCode::state, std::move(message), std::move(remedy));
  };
  if (ended()) {
    if (request == Request::abort) return {};
    return refuse(fmt::format("the run has ended: {}", name(state_of(phase_))), "start a new one");
  }
  const bool paused = in<phase::Paused>() != nullptr;
  const bool measured = !is_measuring(phase_) && !paused;
  switch (request) {
    case Request::abort:
      return {};
    case Request::pause:
      if (paused) return refuse("the run is paused already", "resume or abort it");
      if (measured) return refuse("all poses are measured and the table is at rest", "wait, or abort");
      return {};
    case Request::resume:
      if (asks_for_deed()) return {};
      if (!paused) return refuse("the run is not paused", "");
      if (const std::string other = identity_.exchanged(); !other.empty())
        return refuse(other, identity_.remedy());
      if (!lost_.empty())
        return refuse(fmt::format("{} is not connected: {}", lost_.begin()->first, lost_.begin()->second),
                      "reconnect it, then resume");
      return {};
    case Request::redo:
      if (measured) return refuse("all poses are measured", "wait, or abort");
      if (disk_.unanswered) return refuse("a pose is being stored", "ask again in a moment");
      if (hands_.entered() || (config_.by_hand && progress_.last())) return {};
      return refuse(
          "there is no entry that could be asked for again: none was made yet, or the last one is asked for "
          "again already",
          "mgt run status shows what is asked for now");
    case Request::finish:
      if (measured) return refuse("all poses are measured", "wait, or abort");
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
      return hold(progress_.next() ? "paused by the operator; the pose under way will be measured again"
                                   : "paused by the operator");
    case Request::resume:
      if (asks_for_deed()) return carried_out();
      progress_.forgive();
      hands_.resumed();
      return go_on();
    case Request::finish:
      return finish_early();
    case Request::redo:
      return redo();
  }
}

/// What is being measured is kept, what is only under way is not.
void RunFsm::finish_early() {
  progress_.cut_short();
  if (in<phase::Dwelling>() || in<phase::Storing>()) return;
  if (!in<phase::Paused>() && !is_measuring(phase_)) return;
  act(StopTable{});
  go_on();
}

void RunFsm::hold(const std::string& message) {
  act(StopTable{});
  flush_path();
  field_.paused();
  hands_.paused();
  enter(phase::Paused{}, message);
  act(Record{"paused: " + message_});
}

void RunFsm::abort() {
  if (in<phase::Stopping>()) return;
  if (in<phase::Judging>() || in<phase::Solving>()) act(CancelSolve{});
  act(StopTable{});
  enter(phase::Stopping{}, "aborting: stopping the table");
}

void RunFsm::advance(phase::Stopping&) {
  const bool rests = table_.reported_after(entered_) && !table_.latest()->moving;
  if (rests) {
    finish(RunState::aborted, "aborted by the operator, the table is at rest; " + kept());
  } else if (lost_.contains(Slot::table().name()) || timed_out(config_.wait.stop_max_s)) {
    finish(RunState::aborted,
           fmt::format("aborted by the operator, but {}: look at it; {}",
                       lost_.contains(Slot::table().name()) ? kUnreachable
                                                            : "the table has not reported that it is at rest",
                       kept()));
  }
}

// What is set by hand.

void RunFsm::ask() {
  act(StopTable{});
  enter(phase::Asking{}, hands_.question());
  act(Record{message_});
}

void RunFsm::advance(phase::Asking&) {
  if (timed_out(config_.wait.answer_max_s))
    hold(fmt::format("nothing was entered within {:.0f} min ({}); mgt run resume asks again",
                     config_.wait.answer_max_s / 60, hands_.prompt()->text));
}

Result<void> RunFsm::possible(const ScaleEntered& entered) const {
  if (asks_for_deed())
    return fail(ErrorCode::state, "no scales are asked for now: " + hands_.prompt()->text,
                "when it is done: mgt run resume");
  if (!in<phase::Asking>())
    return fail(ErrorCode::state, "nothing is asked for now",
                "mgt run status shows what is; mgt run redo asks for the last entry again");
  if (!entered.answers(*hands_.prompt()))
    return fail(ErrorCode::state, "that answers another question; asked is now: " + hands_.prompt()->text,
                "enter what the scales say to this one");
  return hands_.possible(entered.angles, config_.limits);
}

void RunFsm::on(const ScaleEntered& entered) {
  if (!possible(entered)) return;
  act(Record{hands_.said(entered.angles)});
  if (!hands_.enter(entered.angles, planned())) return ask();
  go_on();
}

void RunFsm::carried_out() {
  hands_.carried_out(planned());
  field_.paused();  // a coil or a supply may have been switched: the field is taken as it is
  go_on();
}

void RunFsm::redo() {
  act(StopTable{});
  const auto last = progress_.last();
  const HandEntry::Forgotten what = hands_.forget(planned());
  std::vector<int> again;
  for (std::size_t i = 0; i < plan_.poses.size(); ++i) {
    const bool rests_on_it =
        what.mount ? plan_.poses[i].mount == what.mount && progress_.is_done(i) : what.last_pose && last == i;
    if (!rests_on_it) continue;
    again.push_back(plan_.poses[i].number);
    progress_.undo(i);
    hands_.dropped(plan_.poses[i].number);
  }
  progress_.forgive();
  progress_.forget_last();
  if (!again.empty()) act(DropPoses{std::move(again)});
  go_on();
}

// A field that does not stand still.

void RunFsm::suspend(const FieldDisturbance& seen) {
  progress_.repeat();
  act(FieldDisturbed{planned().number, seen});
  const auto* dwelling = in<phase::Dwelling>();
  const bool railed = dwelling && dwelling->dwell.quality().saturated > 0;
  field_.given_up(now_.mono);
  enter(phase::Suspended{},
        fmt::format("pose {} is suspended: {}; {}; it is measured again when the field is calm",
                    planned().number, seen.in_words(),
                    railed ? "a sensor is at the end of its range: look at its supply and range, and for "
                             "magnets and iron near it"
                           : "something magnetic is passing or has been put down nearby, or the array itself "
                             "moves"));
  act(Record{message_});
}

void RunFsm::advance(phase::Suspended&) {
  if (!table_.referenced()) return lost_reference();
  if (field_.waited_s(now_.mono) > config_.wait.calm_max_s)
    return hold(fmt::format(
        "{}; it has not become so within {:.0f} s: look what moves or was put down near the array "
        "and the reference; mgt run resume takes the field as it is",
        message_, config_.wait.calm_max_s));
  const FieldGuard::Calm calm = field_.calm();
  if (calm == FieldGuard::Calm::disturbed) field_.watch(now_.mono);
  if (calm != FieldGuard::Calm::yes) return;
  act(Record{fmt::format("the field is calm after {:.0f} s: pose {} is measured again",
                         to_seconds(now_.mono - entered_), planned().number)});
  go_on();
}

// Another sensor.

void RunFsm::look_at_identity(const InstrumentIdentity& who) {
  if (!identity_.answers(who) || in<phase::Preflighting>()) return;
  const std::string other = identity_.exchanged();
  published_.reset();
  if (other.empty()) {
    act(Record{"every sensor is again the one that this run began with"});
    if (in<phase::Paused>()) message_ = "every sensor answers in its place again; mgt run resume goes on";
  } else if (is_measuring(phase_)) {
    hold(other + "; " + identity_.remedy());
  } else if (in<phase::Paused>()) {
    message_ = other + "; " + identity_.remedy();
  }
}

void RunFsm::on(const ReadingsSay& say) {
  if (in<phase::Preflighting>() || !is_measuring(phase_)) return identity_.remember(say);
  if (identity_.readings_say(say))
    hold(say.measured + "; " + say.remedy + "; when it is meant so: mgt run resume");
}

bool RunFsm::identity_settled() {
  const Check check = checks_.back();
  if (!check.passed) {
    preflight_passed_ = false;
    identity_.ask_once(check);
    hold(check.measured + "; " + check.remedy +
         (identity_.exchanged().empty() ? "; when it is meant so, mgt run resume measures as it is" : ""));
    return false;
  }
  if (!identity_.confirmed().empty()) act(Record{"the operator goes on although " + identity_.confirmed()});
  if (const auto own = identity_.begin(); !own.empty())
    act(StoreChecks{acquire::kInstrumentsStage, acquire::to_checks(own)});
  return true;
}

// A fault, or a device that is lost.

void RunFsm::on(const DeviceLost& lost) {
  const std::string device = lost.slot.name();
  const bool is_table = lost.slot == Slot::table();
  if (is_table) table_.lost();
  lost_.insert_or_assign(device, lost.why);
  published_.reset();
  act(Record{
      fmt::format("{} is lost: {}{}", device, lost.why, is_table ? fmt::format("; {}", kUnreachable) : "")});
  if (auto* now = in<phase::Preflighting>()) {  // it reports on links itself
    LinkHealth health;
    health.detail = lost.why;
    now->preflight.add(device, health);
    return;
  }
  if (!is_measuring(phase_) || in<phase::Waiting>()) return;
  act(StopTable{});
  enter(phase::Waiting{}, "waiting for " + device);
}

void RunFsm::on(const DeviceBack& back) {
  const std::string device = back.slot.name();
  if (lost_.erase(device) == 0) return;
  act(Record{device + " is back"});
  published_.reset();
}

void RunFsm::advance(phase::Waiting&) {
  if (lost_.empty()) return go_on();
  if (timed_out(config_.wait.lost_max_s))
    finish(RunState::failed,
           fmt::format("{} did not come back within {:.0f} s ({}){}; reconnect it and resume the run: {}",
                       lost_.begin()->first, config_.wait.lost_max_s, lost_.begin()->second,
                       lost_.contains(Slot::table().name()) ? "; " + std::string(kUnreachable) : "", kept()));
}

std::string RunFsm::in_status() const {
  const bool unreachable = lost_.contains(Slot::table().name());
  if (in<phase::Waiting>() && !lost_.empty()) {
    std::string who;
    for (const auto& [device, why] : lost_)
      who += fmt::format("{}{} is lost ({})", who.empty() ? "" : ", ", device, why);
    return fmt::format("{}; {}, waiting up to {:.0f} s, then the pose is measured again", who,
                       unreachable ? kUnreachable : "the table is stopped", config_.wait.lost_max_s);
  }
  const bool matters =
      unreachable && !in<phase::Preflighting>() && (is_measuring(phase_) || in<phase::Paused>());
  return matters ? fmt::format("{}; {}", message_, kUnreachable) : message_;
}

void RunFsm::on(const DeviceFaulted& faulted) {
  const std::string device = faulted.slot.name();
  const std::string what = fmt::format("{}: {}{}{}", device, faulted.fault.what,
                                       faulted.fault.remedy.empty() ? "" : "; ", faulted.fault.remedy);
  if (!is_measuring(phase_) || lost_.contains(device)) return act(Record{what});
  if (in<phase::Preflighting>() && progress_.done() == 0) return finish(RunState::failed, what);
  hold(what);
}

}  // namespace mgtd::daemon::run
