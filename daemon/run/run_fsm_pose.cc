// SPDX-License-Identifier: Apache-2.0
// The way of a pose: approach, move, settle, dwell, store, next.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/plan/approach.h"
#include "daemon/run/run_fsm.h"

namespace mgtd::daemon {
namespace {

double furthest_rad(const TableAngles& a, const TableAngles& b) {
  return std::max({std::abs(a.azimuth_rad - b.azimuth_rad), std::abs(a.pitch_rad - b.pitch_rad),
                   std::abs(a.roll_rad - b.roll_rad)});
}

std::string in_words(const TableAngles& a) {
  return fmt::format("azimuth {:.2f}, pitch {:.2f}, roll {:.2f} deg", to_deg(a.azimuth_rad),
                     to_deg(a.pitch_rad), to_deg(a.roll_rad));
}

}  // namespace

void RunFsm::go_on() {
  const auto next = enough_ ? std::nullopt : progress_.next();
  if (unanswered_) {
    enter(Phase::storing, fmt::format("storing pose {}", *unanswered_));
  } else if (next && !preflight_passed_) {
    enter_preflight();
  } else if (next && !homed_) {
    enter_homing();
  } else if (next) {
    enter_pose(*next);
  } else {
    flush_path();
    enter(Phase::solving, fmt::format("fitting {} poses", progress_.done()));
    act(StartSolve{});
  }
}

void RunFsm::enter_preflight() {
  preflight_ = Preflight(config_.preflight, now_.mono);
  watch_field(now_.mono);
  enter(Phase::preflight, "looking at the instruments");
}

void RunFsm::enter_homing() {
  sense_.reset();
  enter(Phase::homing, "reference move of the table");
  act(HomeTable{});
}

void RunFsm::enter_pose(std::size_t index) {
  index_ = index;
  if (!inside(config_.limits, planned().target)) {
    hold(fmt::format(
        "pose {} asks for {}, outside the table's limits; widen the limits in the configuration to "
        "what they were when the run was planned, or abort",
        planned().number, in_words(planned().target)));
    return;
  }
  progress_.begin(index, now_.mono);
  dwell_.reset();
  if (ask_hands()) return;
  if (config_.by_hand) return settle_at_scales();
  const auto by_way_of = waypoint(planned());
  if (!by_way_of) {
    move_to_target();
    return;
  }
  goal_ = *by_way_of;
  sense_ = planned().sense;
  enter(Phase::approaching, fmt::format("pose {} of {}: approaching {}", planned().number, plan_.poses.size(),
                                        in_words(planned().target)));
  act(MoveTable{goal_});
}

/// Where to go first so that the azimuth arrives in its planned sense; none when it does anyway, when it need
/// not, or when the limits leave no room (the sense that is stored is always the real one).
std::optional<TableAngles> RunFsm::waypoint(const PlannedPose& pose) const {
  if (!table_) return std::nullopt;
  return daemon::waypoint(table_->angles, sense_.value_or(0), pose.target, pose.sense, config_.approach_rad,
                          config_.limits);
}

void RunFsm::move_to_target() {
  goal_ = planned().target;
  const int sense = table_ ? sense_of(table_->angles.azimuth_rad, goal_.azimuth_rad) : 0;
  if (sense != 0) sense_ = sense;
  settle_.emplace(config_.settle, now_.mono);
  enter(Phase::moving,
        fmt::format("pose {} of {}: moving to {}", planned().number, plan_.poses.size(), in_words(goal_)));
  act(MoveTable{goal_});
}

void RunFsm::settle_at_scales() {
  goal_ = scales_;
  sense_.reset();
  settle_.emplace(config_.settle, now_.mono);
  enter(Phase::moving,
        fmt::format("pose {} of {}: settling at {}", planned().number, plan_.poses.size(), in_words(goal_)));
  act(SetTable{goal_});
}

/// A table that rests elsewhere may still answer for its last target.
TableReading RunFsm::judged(TableReading reading) const {
  reading.on_target = reading.on_target && furthest_rad(reading.angles, goal_) <= config_.reach_rad;
  return reading;
}

void RunFsm::advance() {
  switch (phase_) {
    case Phase::preflight:
      return advance_preflight();
    case Phase::homing:
      return advance_homing();
    case Phase::asking:
      if (timed_out(config_.answer_max_s))
        hold(fmt::format("nothing was entered within {:.0f} min ({}); mgt run resume asks again",
                         config_.answer_max_s / 60, prompt_->text));
      return;
    case Phase::approaching:
      return advance_approach();
    case Phase::moving:
      return advance_move();
    case Phase::dwelling:
      return advance_dwell();
    case Phase::suspended:
      return advance_suspended();
    case Phase::storing:
      if (timed_out(config_.store_max_s))
        hold(fmt::format("pose {} is not on disk after {:.0f} s; check the disk", planned().number,
                         config_.store_max_s));
      return;
    case Phase::waiting:
      if (lost_.empty()) return go_on();
      if (timed_out(config_.lost_max_s))
        finish(
            RunState::failed,
            fmt::format("{} did not come back within {:.0f} s ({}){}; reconnect it and resume the run: {}",
                        lost_.begin()->first, config_.lost_max_s, lost_.begin()->second,
                        lost_.contains("table") ? "; it cannot be reached and may still move" : "", kept()));
      return;
    case Phase::solving:
      if (timed_out(config_.solve_max_s)) {
        act(CancelSolve{});
        finish(RunState::failed,
               fmt::format("no result of the fit after {:.0f} s; fit the run file by hand: {}",
                           config_.solve_max_s, kept()));
      }
      return;
    case Phase::stopping:
      return advance_stopping();
    case Phase::proposing:
      if (timed_out(config_.store_max_s))
        finish(RunState::failed,
               fmt::format("the calibration is not on disk after {:.0f} s; check the disk: {}",
                           config_.store_max_s, kept()));
      return;
    case Phase::paused:
    case Phase::ended:
      return;
  }
}

void RunFsm::advance_preflight() {
  if (!preflight_.complete(now_.mono)) return;
  checks_ = preflight_.checks(config_.limits, now_.mono);
  preflight_passed_ = all_passed(checks_);
  checks_.push_back(identity_check());
  act(StoreChecks{"preflight", checks_});
  if (preflight_passed_ && !identity_settled()) return;
  if (preflight_passed_) {
    config_.settle.noise_nT = preflight_.noise_nT();
    field_noise_.begin(*still_);
    act(Record{fmt::format("preflight passed: {} checks, noise of a sample {:.2f} nT at most", checks_.size(),
                           config_.settle.noise_nT)});
    homed_ = false;
    go_on();
    return;
  }
  std::string why;
  for (const Check& c : checks_) {
    if (!c.passed)
      why += fmt::format("{}{}: {} (limit {}): {}", why.empty() ? "" : "; ", c.name, c.measured, c.limit,
                         c.remedy);
  }
  if (progress_.done() == 0) {
    finish(RunState::failed, "the preflight failed, the table was not moved: " + why);
  } else {
    hold("the preflight failed: " + why);
  }
}

void RunFsm::advance_homing() {
  if (table_ && table_->arrival.mono > entered_ && table_->referenced && !table_->moving) {
    homed_ = true;
    act(Record{"the table is referenced"});
    go_on();
  } else if (timed_out(config_.home_max_s)) {
    hold(fmt::format(
        "the reference move did not end within {:.0f} s; look whether the table is blocked, and at its "
        "error register",
        config_.home_max_s));
  }
}

void RunFsm::advance_approach() {
  if (!homed_) return lost_reference();
  const bool fresh = table_ && table_->arrival.mono > entered_;
  if (fresh && !table_->moving && judged(*table_).on_target) {
    move_to_target();
  } else if (timed_out(config_.settle.move_max_s)) {
    bad_pose(
        {ErrorCode::protocol,
         fmt::format("the table is not at {} after {:.0f} s", in_words(goal_), config_.settle.move_max_s),
         "look whether the table is blocked, and at its error register"});
  }
}

void RunFsm::advance_move() {
  if (!homed_) return lost_reference();
  const SettleVerdict verdict = settle_->judge(now_.mono);
  if (verdict.state == SettleState::settled && now_.mono >= wished_begin()) return enter_dwell();
  if (verdict.state == SettleState::settled) return;
  if (verdict.state == SettleState::settling) return;
  bad_pose({ErrorCode::refused, fmt::format("not settled: {} (limit {})", verdict.measured, verdict.limit),
            verdict.remedy});
}

/// A pose may ask for a rest before its dwell.
Instant RunFsm::wished_begin() const {
  const auto since = stopped();
  if (!planned().since_stop_s || !since) return now_.mono;
  return *since + from_seconds(*planned().since_stop_s - planned().dwell_s / 2);
}

void RunFsm::lost_reference() {
  bad_pose({ErrorCode::protocol, "the table lost its reference", "check the controller's power"});
}

void RunFsm::enter_dwell() {
  DwellConfig config = config_.dwell;
  config.length_s = planned().dwell_s;
  dwell_.emplace(config, now_.mono);
  watch_field(now_.mono);
  at_rest_.clear();
  enter(Phase::dwelling, fmt::format("pose {} of {}: measuring for {} s", planned().number,
                                     plan_.poses.size(), planned().dwell_s));
}

void RunFsm::advance_dwell() {
  if (!homed_) return lost_reference();
  const bool in_dwell = table_ && table_->arrival.mono >= dwell_->begin();
  if (in_dwell && (table_->moving || furthest_rad(table_->angles, goal_) > config_.reach_rad))
    return bad_pose({ErrorCode::refused,
                     "the table moved during the dwell: it reports " + in_words(table_->angles),
                     "clamp or balance the table, or keep its servo on during the dwell"});
  if (const auto seen = disturbed(planned().dwell_s)) return suspend(seen->in_words());
  if (!dwell_->complete(now_.mono)) return;
  DwellPlace place;
  place.number = planned().number;
  place.set = planned().set;
  place.angles = recorded(angles_at_rest());
  place.mount = planned().mount;
  place.run_start = run_start_;
  place.stopped = stopped();
  place.sense = sense_;
  auto pose = dwell_->pose(place);
  if (!pose) return bad_pose(pose.error());
  if (auto ok = undisturbed(*pose); !ok) return bad_pose(ok.error());
  if (const auto level = at_another_level(pose->f_nT)) return suspend(*level);
  if (!believed(*pose)) return;
  field_noise_.add(*still_);
  store(std::move(*pose));
}

/// As the table reports them: the mean over the dwell, or the last word before it.
TableAngles RunFsm::angles_at_rest() const {
  if (at_rest_.empty()) return table_ ? table_->angles : goal_;
  TableAngles mean;
  const auto n = static_cast<double>(at_rest_.size());
  for (const TableAngles& a : at_rest_) {
    mean.azimuth_rad += a.azimuth_rad / n;
    mean.pitch_rad += a.pitch_rad / n;
    mean.roll_rad += a.roll_rad / n;
  }
  return mean;
}

Result<void> RunFsm::undisturbed(const Pose& pose) const {
  if (config_.preflight.scalar && !pose.f_nT)
    return fail(ErrorCode::refused, "no good reading of the scalar reference in the dwell",
                "see `mgt status`: is it tuned, and does it read at least once per dwell?");
  const double most_nT = config_.settle.disturbed_ratio * config_.settle.noise_nT;
  if (most_nT <= 0) return {};
  for (std::size_t slot = 0; slot < kSensors; ++slot) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double sd_nT = pose.sd_nT[slot][axis].value_or(0);
      if (sd_nT > most_nT)
        return fail(
            ErrorCode::refused,
            fmt::format("disturbed: s{}.{} scatters by {:.2f} nT in the dwell (limit {:.2f} nT, {:.0f} x the "
                        "noise of the preflight)",
                        slot + 1, "xyz"[axis], sd_nT, most_nT, config_.settle.disturbed_ratio),
            "something magnetic moves near the array: keep people, cars and tools away");
    }
  }
  return {};
}

void RunFsm::store(Pose pose) {
  flush_path();
  unanswered_ = pose.number;
  stored_ = pose;
  enter(Phase::storing, fmt::format("storing pose {}", pose.number));
  act(StorePose{std::move(pose)});
}

/// Said when the turns of the table have shown it, and again when further ones show more.
void RunFsm::look_at_wiring(const Pose& pose) {
  constexpr std::size_t kFirst = 4, kLast = 32;
  if (wiring_.attitudes() >= kLast) return;
  wiring_.add(pose.y_nT, pose.angles());
  const std::size_t seen = wiring_.attitudes();
  if (seen < kFirst || (seen & (seen - 1)) != 0) return;
  std::vector<std::string> findings = wiring_.findings();
  if (findings == wiring_told_) return;
  wiring_told_ = std::move(findings);
  const Check check{
      "wiring", wiring_told_.empty(),
      wiring_told_.empty() ? "all four alike" : fmt::format("{}", fmt::join(wiring_told_, "; ")),
      "all four alike, turning as the table does",
      "if it is meant so, go on: the calibration finds every mounting; else look at the sensor's "
      "place and the wires of its axes"};
  act(Record{"wiring: " + check.measured + (check.passed ? "" : "; " + check.remedy)});
  std::erase_if(checks_, [](const Check& c) { return c.name == "wiring"; });
  checks_.push_back(check);
}

void RunFsm::bad_pose(const Error& why) {
  ++attempt_;
  ++retries_;
  const std::string what = fmt::format("pose {}, attempt {}: {}", planned().number, attempt_, why.text());
  act(Record{what});
  if (attempt_ > config_.retries) {
    hold(what);
    return;
  }
  if (!table_ || table_->moving) act(StopTable{});
  go_on();
}

}  // namespace mgtd::daemon
