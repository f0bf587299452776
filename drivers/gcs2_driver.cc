// SPDX-License-Identifier: Apache-2.0
#include "drivers/gcs2_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "proto/units.h"

namespace mgtd::drivers::gcs2 {
namespace {

constexpr std::size_t kLongestReply = 1024;
constexpr double kBusyPoll_s = 0.1;
constexpr double kIdlePoll_s = 1.0;
constexpr double kMoveMargin_s = 10.0;
constexpr double kReferenceMargin_s = 30.0;
constexpr double kLongestReference_deg = 720.0;  ///< a continuous table reports endless travel
constexpr double kRounding_deg = 1e-6;           ///< of a limit read as decimal text

double of(const TableAngles& angles, Turns turns) {
  if (turns == Turns::azimuth) return angles.azimuth_rad;
  return turns == Turns::pitch ? angles.pitch_rad : angles.roll_rad;
}

std::vector<Proof> proofs(const Gcs2Settings& settings) {
  const std::string axis = settings.axes.empty() ? "1" : settings.axes.front().axis;
  return {{query("*IDN?"), std::string(kIdentityForm)},
          {query("POS?", axis), form_of_value(axis)},
          {std::string(kAskMoving), std::string(kPlainForm)}};
}

}  // namespace

Gcs2Driver::Gcs2Driver(Gcs2Settings settings)
    : LineBased({Ending::gcs, kLongestReply, settings.baud}),
      settings_(std::move(settings)),
      queue_(proofs(settings_)) {
  for (const AxisSettings& axis : settings_.axes) {
    axes_.push_back({axis});
    if (axis.limits) travel(limits_, axis.turns) = *axis.limits;
  }
}

std::unique_ptr<Device> Gcs2Driver::make(int /*slot*/, Settings& settings) {
  return std::make_unique<Gcs2Driver>(read_gcs2_settings(settings));
}

void Gcs2Driver::on_open(Stamp now) {
  LineBased::on_open(now);
  now_ = now;
  strange_.clear();
  queue_.open(kStop, now.mono);
  start();
}

void Gcs2Driver::on_close(Stamp now) {
  LineBased::on_close(now);
  now_ = now;
  phase_ = Phase::closed;
  queue_.clear();
  wants_home_ = false;
  wanted_.reset();
  move_.arrived = false;
  move_.axes_moving = 0;
  if (std::exchange(job_, Job::none) != Job::none)
    emit(DeviceFault{
        now, "the port was lost while the table moved: the table cannot be reached and may still move",
        "look at the table before starting again; it is stopped as soon as the port is back"});
}

void Gcs2Driver::on_tick(Stamp now) {
  LineBased::on_tick(now);
  now_ = now;
  if (phase_ == Phase::closed) return;
  if (phase_ == Phase::waiting) {
    if (!retry_.passed(now.mono)) return;
    queue_.interrupt(kStop, now.mono);
    return start();
  }
  if (const auto given_up = queue_.on_tick(now.mono)) {
    give_up(*given_up);
    return;
  }
  move_.overdue = move_.overdue || job_deadline_.passed(now.mono);
  pump();
}

/// A table that answers slowly has its say: only a poll that was begun after the time is over counts.
void Gcs2Driver::took_too_long() {
  std::string where;
  for (const Axis& axis : axes_)
    where +=
        fmt::format(" {} at {:.3f} deg for {:.3f}", axis.settings.name, axis.position_deg, axis.target_deg);
  fault(job_ == Job::homing
            ? fmt::format("the reference move of {} did not end in time", axes_[homing_axis_].settings.name)
            : fmt::format("the table did not reach its target in time:{}", where),
        "check that nothing blocks the table and that velocity_deg_per_s is what it reaches");
}

/// Begins with what the controller is asked first; the stop went before.
void Gcs2Driver::start() {
  phase_ = Phase::starting;
  job_ = Job::none;
  ask(Ask::stop_error, query("ERR?"), kPlainForm);
  ask(Ask::identity, query("*IDN?"), kIdentityForm);
  ask(Ask::axes, query("SAI?"), kPlainForm);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    ask_value(Ask::travel_min, "TMN?", i);
    ask_value(Ask::travel_max, "TMX?", i);
    set(set_velocity(axes_[i].settings.axis, settings_.velocity_deg_per_s));
    ask_value(Ask::referenced, "FRF?", i);
  }
  if (settings_.servo_off_in_dwell) servo(false);
  ask_cycle();
  pump();
}

void Gcs2Driver::pump() {
  if (phase_ == Phase::ready) {
    begin_wanted();
    poll();
  }
  send(queue_.take_send(now_.mono));
}

/// Asked again, it is told again: what became of it, only the answer says.
void Gcs2Driver::set(const std::string& command) {
  queue_.push({Ask::error, command + query("ERR?"), std::string(kPlainForm), 0, printable(command)});
}

void Gcs2Driver::ask(Ask what, std::string bytes, std::string_view form) {
  queue_.push({what, std::move(bytes), std::string(form)});
}

void Gcs2Driver::ask_value(Ask what, std::string_view mnemonic, std::size_t axis) {
  const std::string& name = axes_[axis].settings.axis;
  queue_.push({what, query(mnemonic, name), form_of_value(name), axis});
}

void Gcs2Driver::servo(bool on) {
  for (const Axis& axis : axes_) set(set_servo(axis.settings.axis, on));
}

void Gcs2Driver::ask_cycle() {
  move_.cycle_is_of_it = true;
  move_.asked_overdue = move_.overdue;
  ask(Ask::moving, std::string(kAskMoving), kPlainForm);
  for (std::size_t i = 0; job_ == Job::moving && i < axes_.size(); ++i) ask_value(Ask::on_target, "ONT?", i);
  for (std::size_t i = 0; i < axes_.size(); ++i) ask_value(Ask::position, "POS?", i);
}

void Gcs2Driver::poll() {
  if (!queue_.idle() || now_.mono < next_poll_) return;
  next_poll_ = now_.mono + from_seconds(busy() ? kBusyPoll_s : kIdlePoll_s);
  if (job_ == Job::homing) {
    move_.asked_overdue = move_.overdue;
    ask(Ask::ready, std::string(kAskReady), kReadyForm);
  } else {
    ask_cycle();
  }
}

void Gcs2Driver::home() {
  wants_home_ = true;
  if (phase_ == Phase::ready) pump();
}

void Gcs2Driver::move_to(TableAngles target) {
  wanted_ = target;
  if (phase_ == Phase::ready) pump();
}

void Gcs2Driver::stop() {
  wants_home_ = false;
  wanted_.reset();
  if (phase_ == Phase::closed) return;
  if (phase_ == Phase::starting) {
    queue_.interrupt(kStop, now_.mono);
    start();
  } else if (phase_ == Phase::waiting) {
    send(kStop);
  } else {
    halt();
    pump();
  }
}

void Gcs2Driver::halt() {
  job_ = Job::none;
  move_.arrived = false;
  queue_.interrupt(kStop, now_.mono);
  ask(Ask::stop_error, query("ERR?"), kPlainForm);
  if (settings_.servo_off_in_dwell) servo(false);
  next_poll_ = now_.mono;
}

void Gcs2Driver::begin_wanted() {
  if (wants_home_) {
    if (job_ != Job::none) return;
    wants_home_ = false;
    begin_home();
  } else if (job_ == Job::homing) {
    return;
  } else if (const auto target = std::exchange(wanted_, std::nullopt); target && !refuse_target(*target)) {
    begin_move(*target);
  }
}

void Gcs2Driver::begin_home() {
  homing_axis_ = 0;
  move_.arrived = false;
  job_ = Job::homing;
  reference_next();
  report(true);
}

void Gcs2Driver::reference_next() {
  while (homing_axis_ < axes_.size() && axes_[homing_axis_].referenced) ++homing_axis_;
  if (homing_axis_ == axes_.size()) {
    arrive();
    return;
  }
  const Axis& axis = axes_[homing_axis_];
  set(set_servo(axis.settings.axis, true));
  set(reference(axis.settings.axis));
  const double travel_deg = std::min(axis.travel_max_deg - axis.travel_min_deg, kLongestReference_deg);
  limit_job(travel_deg / settings_.velocity_deg_per_s * 2 + kReferenceMargin_s);
  next_poll_ = now_.mono + from_seconds(kBusyPoll_s);
}

bool Gcs2Driver::refuse_target(const TableAngles& target) {
  std::string what;
  for (const Turns turns : {Turns::azimuth, Turns::pitch, Turns::roll}) {
    const double target_deg = to_deg(of(target, turns));
    const auto axis =
        std::find_if(axes_.begin(), axes_.end(), [&](const Axis& a) { return a.settings.turns == turns; });
    const TableLimits::Range range = travel(limits_, turns);
    const double min_deg = to_deg(range.min_rad), max_deg = to_deg(range.max_rad);
    if (target_deg >= min_deg - kRounding_deg && target_deg <= max_deg + kRounding_deg) continue;
    static constexpr std::array<std::string_view, 3> kNames{"azimuth", "pitch", "roll"};
    what = fmt::format("the target {} = {:.3f} deg lies outside {:.3f} to {:.3f} deg{}",
                       kNames[static_cast<std::size_t>(turns)], target_deg, min_deg, max_deg,
                       axis == axes_.end() ? " (there is no such axis)" : "");
  }
  if (!what.empty()) {
    emit(DeviceFault{now_, std::move(what), "choose poses within the table's travel, or widen its limits"});
    return true;
  }
  if (all_referenced()) return false;
  emit(DeviceFault{now_, "the table was told to move before its reference move", "home the table first"});
  return true;
}

void Gcs2Driver::begin_move(const TableAngles& target) {
  double longest_deg = 0;
  servo(true);
  for (Axis& axis : axes_) {
    axis.target_deg = to_deg(of(target, axis.settings.turns));
    axis.on_target = false;
    longest_deg = std::max(longest_deg, std::abs(axis.target_deg - axis.position_deg));
    set(move(axis.settings.axis, axis.target_deg));
  }
  job_ = Job::moving;
  move_.cycle_is_of_it = false;
  move_.arrived = false;
  move_.longest_s = longest_deg / settings_.velocity_deg_per_s * 2 + kMoveMargin_s;
  limit_job(move_.longest_s);
  next_poll_ = now_.mono;
  report(true);
}

void Gcs2Driver::limit_job(double seconds) {
  job_deadline_.set(now_.mono, seconds);
  move_.overdue = move_.asked_overdue = false;
}

void Gcs2Driver::arrive() {
  move_.arrived = job_ == Job::moving;
  job_ = Job::arriving;
  if (settings_.servo_off_in_dwell) servo(false);
  ask_cycle();
}

void Gcs2Driver::end_of_cycle() {
  if (phase_ == Phase::starting) {
    phase_ = Phase::ready;
    last_start_fault_.clear();
    set_state(LinkState::live, fmt::format("{} {}", axes_.size(), axes_.size() == 1 ? "axis" : "axes"));
    next_poll_ = now_.mono + from_seconds(kIdlePoll_s);
  } else if (job_ == Job::moving) {
    const bool there = std::all_of(axes_.begin(), axes_.end(), [](const Axis& a) { return a.on_target; });
    if (move_.axes_moving == 0 && there && move_.cycle_is_of_it) {
      arrive();
      return;
    }
    if (move_.asked_overdue) return took_too_long();
  } else if (job_ == Job::arriving) {
    job_ = Job::none;
  } else if (move_.arrived) {
    check_dwell();
  }
  report(busy());
}

/// With the servo off nothing holds the table but friction.
void Gcs2Driver::check_dwell() {
  for (const Axis& axis : axes_) {
    if (std::abs(axis.position_deg - axis.target_deg) <= settings_.dwell_tolerance_deg) continue;
    fault(fmt::format("{} turned to {:.3f} deg while the table should stand at {:.3f} deg",
                      axis.settings.name, axis.position_deg, axis.target_deg),
          "check that nothing pushes or unbalances the table; servo_off_in_dwell = false holds it");
    return;
  }
}

}  // namespace mgtd::drivers::gcs2
