// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_fsm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace mgtd::daemon {
namespace {

constexpr double kStatusEvery_s = 1.0;
constexpr std::size_t kPathBuffer = 500;
constexpr double kSamePlace_rad = 1e-5;

bool same_state(const TableReading& a, const TableReading& b) {
  return a.moving == b.moving && a.on_target == b.on_target && a.referenced == b.referenced &&
         std::abs(a.angles.azimuth_rad - b.angles.azimuth_rad) < kSamePlace_rad &&
         std::abs(a.angles.pitch_rad - b.angles.pitch_rad) < kSamePlace_rad &&
         std::abs(a.angles.roll_rad - b.angles.roll_rad) < kSamePlace_rad;
}

bool plans_mounts(const RunPlan& plan) {
  return std::any_of(plan.poses.begin(), plan.poses.end(), [](const auto& p) { return p.mount.has_value(); });
}

/// t_s of a resumed run counts from its first beginning, down time included.
Stamp origin(Stamp now, const std::optional<EarlierLife>& earlier) {
  if (!earlier) return now;
  const Duration by_wall{now.wall.ns - earlier->started_utc.ns};
  return {now.mono - std::max(by_wall, from_seconds(earlier->last_t_s)), earlier->started_utc};
}

}  // namespace

RunFsm::RunFsm(RunConfig config, RunPlan plan, Stamp now, const std::optional<EarlierLife>& earlier)
    : config_(std::move(config)),
      plan_(std::move(plan)),
      progress_(plan_, config_.pace),
      run_start_(origin(now, earlier)),
      now_(now),
      entered_(now.mono),
      message_("looking at the instruments"),
      preflight_(config_.preflight, now.mono),
      field_noise_(config_.dwell.scalar_sd_nT) {
  watch_field(now.mono);
  calibrated_.want(config_.calibrated);
  if (earlier) own_.want(earlier->instruments);
  for (std::size_t i = 0; earlier && i < plan_.poses.size(); ++i) {
    if (earlier->stored.contains(plan_.poses[i].number)) progress_.set_done(i);
  }
  if (!earlier || !by_hand()) return;
  for (const Pose& pose : earlier->poses) field_turn_.add(pose);
}

std::vector<Action> RunFsm::step(const Event& event, Stamp now) {
  if (phase_ == Phase::ended) return {};
  now_ = now;
  std::visit([this](const auto& e) { on(e); }, event);
  if (phase_ != Phase::ended) advance();
  const bool due = !published_ || now.mono - *published_ >= from_seconds(kStatusEvery_s);
  if (phase_ != Phase::ended && (changed_ || due)) publish();
  return std::exchange(actions_, {});
}

void RunFsm::on_sample(const EpochOrGap& item) {
  if (phase_ == Phase::preflight) preflight_.add(item);
  if (phase_ == Phase::moving) settle_->add(item);
  if (watching_field()) still_->add(item);
  if (phase_ == Phase::dwelling) dwell_->add(item);
}

void RunFsm::on(const ScalarReading& reading) {
  if (phase_ == Phase::preflight) preflight_.add(reading);
  if (phase_ == Phase::dwelling) dwell_->add(reading);
  if (watching_field()) still_->add(reading);
}

void RunFsm::on(const AuxiliaryReading& reading) {
  if (phase_ == Phase::dwelling) dwell_->add(reading);
}

void RunFsm::on(const TableReading& reading) {
  // The way of a hand is not known, nor is the attitude while the array is being mounted.
  const bool known = !config_.by_hand && (!plans_mounts(plan_) || mounted_);
  if (known && (!table_ || !same_state(*table_, reading))) {
    path_.push_back(reading);
    path_.back().angles = recorded(reading.angles);
  }
  if (path_.size() >= kPathBuffer) flush_path();
  follow_rest(reading);
  table_ = reading;
  if (!reading.referenced && homed_) homed_ = false;
  if (phase_ == Phase::preflight) preflight_.add(reading);
  if (phase_ == Phase::moving) follow_settling(judged(reading));
  if (phase_ == Phase::dwelling) at_rest_.push_back(reading.angles);
}

void RunFsm::follow_settling(const TableReading& reading) {
  const bool stopped = settle_->stopped().has_value();
  settle_->add(reading);
  if (settle_->stopped().has_value() == stopped) return;
  message_ =
      fmt::format("pose {} of {}: {}", planned().number, plan_.poses.size(), stopped ? "moving" : "settling");
  changed_ = true;
}

void RunFsm::on(const LinkSeen& seen) {
  if (phase_ == Phase::preflight) preflight_.add(seen.device, seen.health);
  if (answers(seen.health.state)) look_at_identity({seen.device, seen.health.identity});
  const auto lost = lost_.find(seen.device);
  if (lost == lost_.end() || answers(seen.health.state) || lost->second == seen.health.detail) return;
  lost->second = seen.health.detail;
  changed_ = true;
}

void RunFsm::on(const PoseStored& stored) {
  if (unanswered_ != stored.number) return;
  unanswered_.reset();
  changed_ = true;
  if (stored.result) {
    for (std::size_t i = 0; i < plan_.poses.size(); ++i) {
      if (plan_.poses[i].number != stored.number) continue;
      progress_.finish(i, now_.mono);
      last_stored_ = i;
    }
    if (stored_ && by_hand() && !doubtful_) field_turn_.add(*stored_);
    if (stored_) level_nT_ = stored_->f_nT;
    if (stored_) look_at_wiring(*stored_);
    stored_.reset();
    attempt_ = 0;
    disturbed_since_.reset();
    if (phase_ == Phase::storing) go_on();
  } else if (measuring()) {
    hold(fmt::format("pose {} could not be stored and will be measured again: {}", stored.number,
                     stored.result.error().text()));
  }
}

void RunFsm::on(const AccuracyKnown& known) {
  tensor_sd_nT_per_m_ = known.tensor_sd_nT_per_m;
  changed_ = true;
  const auto wanted = config_.until_tensor_sd_nT_per_m;
  if (!wanted || known.tensor_sd_nT_per_m > *wanted || enough_) return;
  act(Record{fmt::format("with {} poses the tensor is known to {:.3g} nT/m, {:.3g} was wanted: no more poses",
                         known.poses, known.tensor_sd_nT_per_m, *wanted)});
  finish_early();
}

void RunFsm::on(const SolveDone& solved) {
  if (phase_ != Phase::solving) return;
  if (!solved.result) {
    const bool refused = solved.result.error().code == ErrorCode::refused;
    finish(refused ? RunState::rejected : RunState::failed,
           "no calibration from these poses: " + solved.result.error().text());
    return;
  }
  checks_ = solved.result->checks;
  act(StoreChecks{"verdict", checks_});
  if (!solved.result->accepted) {
    std::string why;
    for (const std::string& reason : solved.result->reasons) why += (why.empty() ? "" : "; ") + reason;
    finish(RunState::rejected, "the calibration was not accepted: " + why);
    return;
  }
  proposed_ = solved.result->calibration_id;
  left_over_ = solved.result->left_over;
  enter(Phase::proposing, "proposing calibration " + proposed_);
  act(ProposeCalibration{proposed_});
}

void RunFsm::on(const CalibrationProposed& proposed) {
  if (phase_ != Phase::proposing) return;
  if (proposed.result) {
    std::string said = fmt::format("calibration {} is proposed: accept it to make it active", proposed_);
    if (!left_over_.empty()) said += fmt::format(". But {}: mgt explain says what is missing", left_over_);
    finish(RunState::done, std::move(said));
    return;
  }
  finish(RunState::failed, fmt::format("calibration {} could not be kept: {}", std::exchange(proposed_, {}),
                                       proposed.result.error().text()));
}

bool RunFsm::measuring() const {
  switch (phase_) {
    case Phase::preflight:
    case Phase::homing:
    case Phase::asking:
    case Phase::approaching:
    case Phase::moving:
    case Phase::dwelling:
    case Phase::suspended:
    case Phase::storing:
    case Phase::waiting:
      return true;
    default:
      return false;
  }
}

void RunFsm::enter(Phase phase, std::string message) {
  phase_ = phase;
  entered_ = now_.mono;
  message_ = std::move(message);
  changed_ = true;
}

void RunFsm::finish(RunState state, const std::string& message) {
  if (state != RunState::done) act(StopTable{});
  if (state != RunState::done) proposed_.clear();
  flush_path();
  final_ = state;
  enter(Phase::ended, message);
  publish();
  act(Finish{state, message});
}

void RunFsm::flush_path() {
  if (!path_.empty()) act(StorePath{std::exchange(path_, {})});
}

void RunFsm::publish() {
  published_ = now_.mono;
  changed_ = false;
  act(PublishStatus{status(now_.mono)});
}

std::string RunFsm::kept() const {
  return progress_.done() == 0 ? "no pose was measured"
                               : fmt::format("the {} poses measured are kept", progress_.done());
}

RunState RunFsm::state() const {
  switch (phase_) {
    case Phase::preflight:
      return RunState::preflight;
    case Phase::homing:
      return RunState::homing;
    case Phase::asking:
      return RunState::asking;
    case Phase::approaching:
      return RunState::moving;
    case Phase::moving:
      return settle_->stopped() ? RunState::settling : RunState::moving;
    case Phase::dwelling:
    case Phase::storing:
      return RunState::dwelling;
    case Phase::suspended:
      return RunState::suspended;
    case Phase::paused:
    case Phase::waiting:
      return RunState::paused;
    case Phase::solving:
    case Phase::proposing:
      return RunState::solving;
    case Phase::stopping:
      return RunState::aborting;
    case Phase::ended:
      return final_;
  }
  return final_;
}

RunStatus RunFsm::status(Instant now) const {
  RunStatus s;
  s.run_id = config_.run_id;
  s.state = state();
  if (phase_ == Phase::asking) s.prompt = prompt_;
  if (index_ < plan_.poses.size()) s.set = planned().set;
  s.pose = static_cast<int>(progress_.done());
  s.poses = static_cast<int>(plan_.poses.size());
  s.retries = retries_;
  s.elapsed_s = to_seconds(now - run_start_.mono);
  s.remaining_s = phase_ == Phase::ended ? 0 : progress_.remaining_s(now);
  s.message = in_status();
  s.goes_on = phase_ == Phase::waiting;
  s.proposed = final_ == RunState::done ? proposed_ : "";
  s.checks = checks_;
  s.tensor_sd_nT_per_m = tensor_sd_nT_per_m_;
  s.wanted_tensor_sd_nT_per_m = config_.until_tensor_sd_nT_per_m;
  return s;
}

}  // namespace mgtd::daemon
