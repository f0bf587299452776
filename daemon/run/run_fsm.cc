// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_fsm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "daemon/run/run_clock.h"

namespace mgtd::daemon::run {
namespace {

constexpr double kStatusEvery_s = 1.0;

/// t_s of a resumed run counts from its first beginning, down time included.
Stamp origin(Stamp now, const std::optional<EarlierLife>& earlier) {
  if (!earlier) return now;
  const Duration by_wall{now.wall.ns - earlier->started_utc.ns};
  return {now.mono - std::max(by_wall, from_seconds(earlier->last_t_s)), earlier->started_utc};
}

FieldGuardConfig field_guard(const RunConfig& config) {
  return {.limits = config.disturbance,
          .step_nT = config.field_step_nT,
          .calm_s = config.calm_s,
          .rate_hz = config.dwell.rate_hz,
          .sensors = config.sensors,
          .scalar_sd_nT = config.dwell.scalar_sd_nT};
}

}  // namespace

RunFsm::RunFsm(RunConfig config, plan::RunPlan plan, Stamp now, const std::optional<EarlierLife>& earlier)
    : config_(std::move(config)),
      plan_(std::move(plan)),
      progress_(plan_, config_.pace),
      run_start_(origin(now, earlier)),
      now_(now),
      phase_(phase::Preflighting{Preflight(config_.preflight, now.mono, config_.sensors)}),
      entered_(now.mono),
      message_("looking at the instruments"),
      hands_(config_.by_hand, plan_, earlier ? earlier->poses : std::vector<Pose>{}),
      field_(field_guard(config_), now.mono),
      identity_(config_.calibrated, earlier ? earlier->instruments : std::vector<InstrumentIdentity>{}) {
  for (std::size_t i = 0; earlier && i < plan_.poses.size(); ++i) {
    if (earlier->stored.contains(plan_.poses[i].number)) progress_.set_done(i);
  }
}

std::vector<Action> RunFsm::step(const Event& event, Stamp now) {
  if (ended()) return {};
  now_ = now;
  std::visit([this](const auto& e) { on(e); }, event);
  std::visit([this](auto& phase) { advance(phase); }, phase_);
  const bool due = !published_ || now.mono - *published_ >= from_seconds(kStatusEvery_s);
  if (!ended() && due) publish();
  return std::exchange(actions_, {});
}

void RunFsm::on_sample(const EpochOrGap& item) {
  if (auto* now = in<phase::Preflighting>()) now->preflight.add(item);
  if (auto* now = in<phase::Moving>()) now->settle.add(item);
  if (auto* now = in<phase::Dwelling>()) now->dwell.add(item);
  if (watches_field()) field_.add(item);
}

void RunFsm::on(const ScalarReading& reading) {
  if (auto* now = in<phase::Preflighting>()) now->preflight.add(reading);
  if (auto* now = in<phase::Dwelling>()) now->dwell.add(reading);
  if (watches_field()) field_.add(reading);
}

void RunFsm::on(const AuxiliaryReading& reading) {
  if (auto* now = in<phase::Dwelling>()) now->dwell.add(reading);
}

void RunFsm::on(const TableReading& reading) {
  table_.add(reading, hands_.way_known() ? std::optional(hands_.platform(reading.angles)) : std::nullopt);
  if (table_.path_full()) flush_path();
  if (auto* now = in<phase::Preflighting>()) now->preflight.add(reading);
  if (auto* now = in<phase::Moving>()) follow_settling(*now, reading);
  if (auto* now = in<phase::Dwelling>()) now->reported.push_back(reading.angles);
}

void RunFsm::follow_settling(phase::Moving& moving, const TableReading& reading) {
  const bool stopped = moving.settle.stopped().has_value();
  // A table that rests elsewhere may still answer for its last target.
  TableReading judged = reading;
  judged.on_target = reached(reading, moving.goal);
  moving.settle.add(judged);
  if (moving.settle.stopped().has_value() == stopped) return;
  message_ = fmt::format("{}: {}", pose_of(), stopped ? "moving" : "settling");
  published_.reset();
}

void RunFsm::on(const LinkSeen& seen) {
  const std::string device = seen.slot.name();
  if (auto* now = in<phase::Preflighting>()) now->preflight.add(device, seen.health);
  if (answers(seen.health.state)) look_at_identity({device, seen.health.identity});
  const auto lost = lost_.find(device);
  if (lost == lost_.end() || answers(seen.health.state) || lost->second == seen.health.detail) return;
  lost->second = seen.health.detail;
  published_.reset();
}

void RunFsm::on(const PoseStored& stored) {
  if (!disk_.unanswered || disk_.unanswered->number != stored.number) return;
  const Pose pose = *std::exchange(disk_.unanswered, std::nullopt);
  published_.reset();
  if (!stored.result) {
    if (is_measuring(phase_))
      hold(fmt::format("pose {} could not be stored and will be measured again: {}", stored.number,
                       stored.result.error().text()));
    return;
  }
  for (std::size_t i = 0; i < plan_.poses.size(); ++i) {
    if (plan_.poses[i].number == stored.number) progress_.finish(i, now_.mono);
  }
  hands_.stored(pose);
  field_.stored(pose.f_nT);
  if (const auto check = wiring_.add(pose)) {
    act(Record{"wiring: " + check->measured + (check->passed ? "" : "; " + check->remedy)});
    std::erase_if(checks_, [](const Check& c) { return c.name == "wiring"; });
    checks_.push_back(*check);
  }
  if (in<phase::Storing>()) go_on();
}

void RunFsm::on(const PosesDropped& dropped) {
  if (dropped.result) return;
  disk_.undropped = dropped.numbers;
  if (in<phase::Stopping>() || in<phase::Ended>()) return;
  if (in<phase::Judging>() || in<phase::Solving>()) act(CancelSolve{});
  hold(
      fmt::format("{} to be measured again but could not be taken out of the run file: {}; mgt run resume "
                  "tries again, and so does the end of the run; a daemon that is restarted before keeps it",
                  dropped.numbers.size() == 1 ? fmt::format("pose {} is", dropped.numbers.front())
                                              : fmt::format("poses {} are", fmt::join(dropped.numbers, ", ")),
                  dropped.result.error().text()));
}

void RunFsm::on(const AccuracyKnown& known) {
  known_.tensor_sd_nT_per_m = known.tensor_sd_nT_per_m;
  published_.reset();
  const auto wanted = config_.until_tensor_sd_nT_per_m;
  if (!wanted || known.tensor_sd_nT_per_m > *wanted || progress_.cut()) return;
  act(Record{fmt::format("with {} poses the tensor is known to {:.3g} nT/m, {:.3g} was wanted: no more poses",
                         known.poses, known.tensor_sd_nT_per_m, *wanted)});
  finish_early();
}

void RunFsm::on(const FurtherPoses& further) {
  if (!in<phase::Judging>()) return;
  known_.judged = further.judgement.found + "; " + further.judgement.next;
  act(Record{known_.judged});
  plan_.poses.insert(plan_.poses.end(), further.poses.begin(), further.poses.end());
  act(StoreJudgement{further.judgement, plan_});
  if (further.poses.empty()) return solve();
  progress_.extend(plan_, config_.pace);
  hands_.extend(plan_.poses.size());
  if (const std::string other = identity_.exchanged(); !other.empty())
    return hold(other + "; " + identity_.remedy());
  if (lost_.empty()) return go_on();
  enter(phase::Waiting{}, "waiting for " + lost_.begin()->first);
}

void RunFsm::on(const SolveDone& solved) {
  if (!in<phase::Solving>()) return;
  if (!solved.result) {
    const bool refused = solved.result.error().code == ErrorCode::refused;
    finish(refused ? RunState::rejected : RunState::failed,
           "no calibration from these poses: " + solved.result.error().text());
    return;
  }
  checks_ = solved.result->checks;
  act(StoreChecks{"verdict", checks_});
  if (!solved.result->accepted) {
    finish(RunState::rejected,
           fmt::format("the calibration was not accepted: {}", fmt::join(solved.result->reasons, "; ")));
    return;
  }
  const std::string& id = solved.result->calibration_id;
  enter(phase::Proposing{id, solved.result->left_over}, "proposing calibration " + id);
  act(ProposeCalibration{id});
}

void RunFsm::on(const CalibrationProposed& proposed) {
  const auto* now = in<phase::Proposing>();
  if (!now) return;
  const auto [id, left_over] = *now;
  if (!proposed.result)
    return finish(RunState::failed,
                  fmt::format("calibration {} could not be kept: {}", id, proposed.result.error().text()));
  std::string said = fmt::format("calibration {} is proposed: accept it to make it active", id);
  if (!left_over.empty())
    said += fmt::format(". But {}: {}", left_over,
                        known_.judged.empty() ? "mgt explain says what is missing" : known_.judged);
  finish(RunState::done, said, id);
}

void RunFsm::enter(Phase phase, std::string message) {
  phase_ = std::move(phase);
  entered_ = now_.mono;
  message_ = std::move(message);
  published_.reset();
}

void RunFsm::finish(RunState state, const std::string& message, const std::string& proposed) {
  if (state != RunState::done) act(StopTable{});
  if (!disk_.undropped.empty()) act(DropPoses{std::exchange(disk_.undropped, {})});
  flush_path();
  enter(phase::Ended{state, proposed}, message);
  publish();
  act(Finish{state, message_});
}

void RunFsm::flush_path() {
  std::vector<TableReading> path = table_.take_path();
  if (path.empty()) return;
  for (TableReading& reading : path) reading.arrival.wall = wall_in_run(run_start_, reading.arrival.mono);
  act(StorePath{std::move(path)});
}

void RunFsm::publish() {
  published_ = now_.mono;
  act(PublishStatus{status(now_.mono)});
}

std::string RunFsm::pose_of() const {
  return fmt::format("pose {} of {}", planned().number, plan_.poses.size());
}

std::string RunFsm::kept() const {
  return progress_.done() == 0 ? "no pose was measured"
                               : fmt::format("the {} poses measured are kept", progress_.done());
}

RunStatus RunFsm::status(Instant now) const {
  RunStatus s;
  s.run_id = config_.run_id;
  s.state = state_of(phase_);
  if (in<phase::Asking>()) s.prompt = hands_.prompt();
  if (progress_.index() < plan_.poses.size()) s.set = planned().set;
  s.pose = static_cast<int>(progress_.done());
  s.poses = static_cast<int>(plan_.poses.size());
  s.retries = progress_.retries();
  if (watches_field()) s.field_change = field_.change();
  s.elapsed_s = to_seconds(now - run_start_.mono);
  s.remaining_s = ended() ? 0 : progress_.remaining_s(now);
  s.message = in_status();
  s.goes_on = in<phase::Waiting>() != nullptr;
  if (const auto* end = in<phase::Ended>()) s.proposed = end->proposed;
  s.checks = checks_;
  s.tensor_sd_nT_per_m = known_.tensor_sd_nT_per_m;
  s.judged = known_.judged;
  s.wanted_tensor_sd_nT_per_m = config_.until_tensor_sd_nT_per_m;
  return s;
}

}  // namespace mgtd::daemon::run
