// SPDX-License-Identifier: Apache-2.0
// The way of a pose: asked for, approached, reached, settled, measured, stored; and what comes next.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "daemon/plan/approach.h"
#include "daemon/run/angles_text.h"
#include "daemon/run/run_fsm.h"

namespace mgtd::daemon::run {

void RunFsm::go_on() {
  const auto next = progress_.next();
  if (!disk_.undropped.empty()) act(DropPoses{std::exchange(disk_.undropped, {})});
  if (disk_.unanswered) {
    enter(phase::Storing{}, fmt::format("storing pose {}", disk_.unanswered->number));
  } else if (next && !preflight_passed_) {
    begin_preflight();
  } else if (next && !table_.referenced()) {
    table_.set_sense(std::nullopt);
    enter(phase::Homing{}, "reference move of the table");
    act(HomeTable{});
  } else if (next) {
    begin_pose(*next);
  } else if (config_.until_explained && !progress_.cut()) {
    flush_path();
    enter(phase::Judging{}, fmt::format("judging {} poses: is anything left to explain?", progress_.done()));
    act(JudgeRun{});
  } else {
    solve();
  }
}

void RunFsm::solve() {
  flush_path();
  enter(phase::Solving{}, fmt::format("fitting {} poses", progress_.done()));
  act(StartSolve{});
}

void RunFsm::begin_preflight() {
  field_.watch(now_.mono);
  enter(phase::Preflighting{Preflight(config_.preflight, now_.mono, config_.sensors)},
        "looking at the instruments");
}

void RunFsm::begin_pose(std::size_t index) {
  progress_.begin(index, now_.mono);
  if (!plan::inside(config_.limits, planned().target)) {
    hold(fmt::format(
        "pose {} asks for {}, outside the table's limits; widen the limits in the configuration to "
        "what they were when the run was planned, or abort",
        planned().number, angles_text(planned().target)));
    return;
  }
  if (hands_.ask_before(planned())) return ask();
  if (config_.by_hand) return settle_at_scales();
  const auto by_way_of = waypoint();
  if (!by_way_of) return move_to_target();
  table_.set_sense(planned().sense);
  enter(phase::Approaching{*by_way_of},
        fmt::format("{}: approaching {}", pose_of(), angles_text(planned().target)));
  act(MoveTable{*by_way_of});
}

/// Where to go first so that the azimuth arrives in its planned sense; none when it does anyway, when it need
/// not, or when the limits leave no room (the sense that is stored is always the real one).
std::optional<TableAngles> RunFsm::waypoint() const {
  if (!table_.latest()) return std::nullopt;
  return plan::waypoint(table_.latest()->angles, table_.sense().value_or(0), planned().target,
                        planned().sense, config_.approach_rad, config_.limits);
}

void RunFsm::move_to_target() {
  const TableAngles goal = planned().target;
  const int sense =
      table_.latest() ? plan::sense_of(table_.latest()->angles.azimuth_rad, goal.azimuth_rad) : 0;
  if (sense != 0) table_.set_sense(sense);
  enter(phase::Moving{goal, Settle(config_.settle, now_.mono)},
        fmt::format("{}: moving to {}", pose_of(), angles_text(goal)));
  act(MoveTable{goal});
}

void RunFsm::settle_at_scales() {
  const TableAngles goal = hands_.scales();
  table_.set_sense(std::nullopt);
  enter(phase::Moving{goal, Settle(config_.settle, now_.mono)},
        fmt::format("{}: settling at {}", pose_of(), angles_text(goal)));
  act(SetTable{goal});
}

bool RunFsm::reached(const TableReading& reading, const TableAngles& goal) const {
  return reading.on_target && furthest_rad(reading.angles, goal) <= config_.reach_rad;
}

void RunFsm::advance(phase::Preflighting& now) {
  now.preflight.passes(now_.mono);
  if (!now.preflight.complete(now_.mono)) return;
  checks_ = now.preflight.checks(config_.limits);
  preflight_passed_ = all_passed(checks_);
  checks_.push_back(identity_.check());
  act(StoreChecks{"preflight", checks_});
  if (preflight_passed_ && !identity_settled()) return;
  if (preflight_passed_) {
    config_.settle.noise_nT = now.preflight.noise_nT();
    field_.begin_noise();
    act(Record{fmt::format("preflight passed: {} checks, noise of a sample {:.2f} nT at most", checks_.size(),
                           config_.settle.noise_nT)});
    table_.set_referenced(false);
    return go_on();
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

void RunFsm::advance(phase::Homing&) {
  if (table_.reported_after(entered_) && table_.latest()->referenced && !table_.latest()->moving) {
    table_.set_referenced(true);
    act(Record{"the table is referenced"});
    go_on();
  } else if (timed_out(config_.wait.home_max_s)) {
    hold(fmt::format(
        "the reference move did not end within {:.0f} s; look whether the table is blocked, and at its "
        "error register",
        config_.wait.home_max_s));
  }
}

void RunFsm::advance(phase::Approaching& now) {
  if (!table_.referenced()) return lost_reference();
  if (table_.reported_after(entered_) && !table_.latest()->moving && reached(*table_.latest(), now.goal)) {
    move_to_target();
  } else if (timed_out(config_.settle.move_max_s)) {
    bad_pose({ErrorCode::protocol,
              fmt::format("the table is not at {} after {:.0f} s", angles_text(now.goal),
                          config_.settle.move_max_s),
              "look whether the table is blocked, and at its error register"});
  }
}

void RunFsm::advance(phase::Moving& now) {
  if (!table_.referenced()) return lost_reference();
  const SettleOutcome outcome = now.settle.judge(now_.mono);
  if (outcome.state == SettleState::settling) return;
  if (outcome.state == SettleState::settled) {
    if (now_.mono >= wished_begin(now)) begin_dwell(now);
    return;
  }
  bad_pose({ErrorCode::refused, fmt::format("not settled: {} (limit {})", outcome.measured, outcome.limit),
            outcome.remedy});
}

/// When the table really came to rest.
std::optional<Instant> RunFsm::stopped(std::optional<Instant> on_target) const {
  const auto rests = table_.rests_since();
  return rests && on_target ? std::min(*rests, *on_target) : on_target;
}

/// A pose may ask for a rest before its dwell.
Instant RunFsm::wished_begin(const phase::Moving& moving) const {
  const auto since = stopped(moving.settle.stopped());
  if (!planned().since_stop_s || !since) return now_.mono;
  return *since + from_seconds(*planned().since_stop_s - planned().dwell_s / 2);
}

void RunFsm::lost_reference() {
  bad_pose({ErrorCode::protocol, "the table lost its reference", "check the controller's power"});
}

void RunFsm::begin_dwell(const phase::Moving& moving) {
  DwellConfig config = config_.dwell;
  config.length_s = planned().dwell_s;
  field_.watch(now_.mono);
  enter(phase::Dwelling{moving.goal, Dwell(config, now_.mono, config_.sensors), moving.settle.stopped()},
        fmt::format("{}: measuring for {} s", pose_of(), planned().dwell_s));
}

void RunFsm::advance(phase::Dwelling& now) {
  if (!table_.referenced()) return lost_reference();
  const auto& table = table_.latest();
  const bool in_dwell = table && table->arrival.mono >= now.dwell.begin();
  if (in_dwell && (table->moving || furthest_rad(table->angles, now.goal) > config_.reach_rad))
    return bad_pose({ErrorCode::refused,
                     "the table moved during the dwell: it reports " + angles_text(table->angles),
                     "clamp or balance the table, or keep its servo on during the dwell"});
  if (const auto seen = field_.disturbed(planned().dwell_s)) return suspend(*seen);
  if (!now.dwell.complete(now_.mono)) return;
  DwellPlace place;
  place.number = planned().number;
  place.set = planned().set;
  place.angles = hands_.platform(angles_at_rest(now));
  place.mount = planned().mount;
  place.run_start = run_start_;
  place.stopped = stopped(now.on_target);
  place.sense = table_.sense();
  auto pose = now.dwell.pose(place);
  if (!pose) return bad_pose(pose.error());
  if (auto ok = undisturbed(*pose); !ok) return bad_pose(ok.error());
  if (const auto level = field_.at_another_level(pose->f_nT)) return suspend(*level);
  const HandEntry::Judgement entry = hands_.judge(*pose, planned());
  if (!entry.stands) return ask();
  if (!entry.against.empty()) act(Record{"the operator stands by the entry: " + entry.against});
  field_.add_to_noise();
  store(std::move(*pose));
}

/// As the table reports them: the mean over the dwell, or what it said last before it.
TableAngles RunFsm::angles_at_rest(const phase::Dwelling& dwelling) const {
  if (dwelling.reported.empty()) return table_.latest() ? table_.latest()->angles : dwelling.goal;
  TableAngles mean;
  const auto n = static_cast<double>(dwelling.reported.size());
  for (const TableAngles& a : dwelling.reported) {
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
  for (std::size_t slot = 0; slot < pose.sd_nT.size(); ++slot) {
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
  disk_.unanswered = pose;
  enter(phase::Storing{}, fmt::format("storing pose {}", pose.number));
  act(StorePose{std::move(pose)});
}

void RunFsm::advance(phase::Storing&) {
  if (timed_out(config_.wait.store_max_s))
    hold(fmt::format("pose {} is not on disk after {:.0f} s; check the disk", planned().number,
                     config_.wait.store_max_s));
}

void RunFsm::advance(phase::Judging&) {
  if (!timed_out(config_.wait.judge_max_s)) return;
  act(CancelSolve{});
  act(Record{fmt::format("no judgement after {:.0f} s: nothing more is measured", config_.wait.judge_max_s)});
  solve();
}

void RunFsm::advance(phase::Solving&) {
  if (!timed_out(config_.wait.solve_max_s)) return;
  act(CancelSolve{});
  finish(RunState::failed, fmt::format("no result of the fit after {:.0f} s; fit the run file by hand: {}",
                                       config_.wait.solve_max_s, kept()));
}

void RunFsm::advance(phase::Proposing&) {
  if (timed_out(config_.wait.store_max_s))
    finish(RunState::failed, fmt::format("the calibration is not on disk after {:.0f} s; check the disk: {}",
                                         config_.wait.store_max_s, kept()));
}

void RunFsm::bad_pose(const Error& why) {
  const int attempt = progress_.failed();
  const std::string what = fmt::format("pose {}, attempt {}: {}", planned().number, attempt, why.text());
  act(Record{what});
  if (attempt > config_.retries) return hold(what);
  if (!table_.latest() || table_.latest()->moving) act(StopTable{});
  go_on();
}

}  // namespace mgtd::daemon::run
