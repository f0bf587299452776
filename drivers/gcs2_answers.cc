// SPDX-License-Identifier: Apache-2.0
// The half of Gcs2Driver that listens: answers, and what follows when one says no or none comes.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "drivers/gcs2_driver.h"
#include "drivers/identity.h"
#include "proto/units.h"

namespace mgtd::drivers::gcs2 {
namespace {

constexpr double kGcs2Retry_s = 5.0;
constexpr int kNotReferenced = 5;

}  // namespace

FrameResult Gcs2Driver::on_line(std::string_view line, Stamp arrival) {
  now_ = arrival;
  if (line.empty()) return FrameResult::resync();
  const std::string form = form_of(line);
  const Heard heard = queue_.hear(form, arrival.mono);
  if (heard == Heard::strange && !form.empty() && form != kReadyForm) strange_ = line;
  if (heard == Heard::answer) {
    const Question question = queue_.current();
    if (!take(question, line)) {
      queue_.refused(arrival.mono);
      return FrameResult::rejected(Reject::number);
    }
    strange_.clear();
  }
  if (phase_ != Phase::waiting) pump();
  return heard == Heard::answer ? FrameResult::accepted() : FrameResult::resync();
}

bool Gcs2Driver::take(const Question& question, std::string_view line) {
  switch (question.ask) {
    case Ask::error:
    case Ask::stop_error:
      return take_error(question, line);
    case Ask::identity:
    case Ask::axes:
    case Ask::travel_min:
    case Ask::travel_max:
      return take_start_up(question, line);
    default:
      return take_state(question, line);
  }
}

bool Gcs2Driver::take_error(const Question& question, std::string_view line) {
  const std::optional<int> error = parse_error(line);
  if (!error) return false;
  queue_.answered();
  if (*error == 0) {
    // The table has its time from when it was told, however long the telling took.
    if (job_ == Job::moving && question.concerning.starts_with("MOV")) limit_job(move_.longest_s);
    return true;
  }
  const ErrorText text = explain(*error);
  if (question.ask == Ask::stop_error) {  // whatever happened before the stop is history
    if (*error != kStoppedByCommand) emit(DeviceNote{now_, "when stopped: " + text.what});
  } else if (phase_ == Phase::starting) {
    fail_start(fmt::format("'{}': {}", question.concerning, text.what), text.remedy);
  } else {
    fault(fmt::format("'{}': {}", question.concerning, text.what), text.remedy);
    // Its power failed: its velocity is forgotten too, and whether it is referenced is to be asked.
    if (*error != kNotReferenced) return true;
    queue_.interrupt(kStop, now_.mono);
    start();
  }
  return true;
}

bool Gcs2Driver::take_start_up(const Question& question, std::string_view line) {
  if (question.ask == Ask::identity) {
    queue_.answered();
    if (health_.identity != line) emit(DeviceNote{now_, "identified as " + std::string(line)});
    health_.identity = line;
    if (auto wanted = check_serial(settings_.serial, serial_of_idn(line)); !wanted)
      fail_start(wanted.error().message, wanted.error().remedy);
    return true;
  }
  if (question.ask == Ask::axes) {
    queue_.answered();
    on_axes(parse_axes(line));
    return true;
  }
  Axis& axis = axes_[question.axis];
  const std::optional<double> value = parse_value(line, axis.settings.axis);
  if (!value) return false;
  queue_.answered();
  (question.ask == Ask::travel_min ? axis.travel_min_deg : axis.travel_max_deg) = *value;
  if (question.ask == Ask::travel_max) narrow_limits(axis);
  return true;
}

bool Gcs2Driver::take_state(const Question& question, std::string_view line) {
  Axis& axis = axes_[question.axis];
  if (question.ask == Ask::moving) {
    const auto mask = parse_moving(line);
    if (mask) move_.axes_moving = *mask;
    if (mask) queue_.answered();
    return mask.has_value();
  }
  if (question.ask == Ask::position) {
    const auto value = parse_value(line, axis.settings.axis);
    if (!value) return false;
    axis.position_deg = *value;
    queue_.answered();
    if (question.axis + 1 == axes_.size()) end_of_cycle();
    return true;
  }
  const auto flag = question.ask == Ask::ready ? parse_ready(line) : parse_flag(line, axis.settings.axis);
  if (!flag) return false;
  queue_.answered();
  if (question.ask == Ask::on_target) axis.on_target = *flag;
  if (question.ask == Ask::referenced) on_referenced(axis, *flag);
  if (question.ask == Ask::ready && *flag) ask_value(Ask::referenced, "FRF?", homing_axis_);
  if (question.ask == Ask::ready && !*flag && move_.asked_overdue) took_too_long();
  return true;
}

void Gcs2Driver::on_axes(const std::vector<std::string>& present) {
  for (const Axis& axis : axes_) {
    if (std::find(present.begin(), present.end(), axis.settings.axis) != present.end()) continue;
    fail_start(fmt::format("the controller has no axis '{}'; it answers '{}'", axis.settings.axis,
                           fmt::join(present, "', '")),
               "correct axes in the configuration, or check which device is on this port");
    return;
  }
}

void Gcs2Driver::on_referenced(Axis& axis, bool yes) {
  axis.referenced = yes;
  if (job_ != Job::homing) return;
  if (yes) {
    reference_next();
  } else {
    fault(fmt::format("{}: {}", axis.settings.name, explain(45).what), explain(45).remedy);
  }
}

void Gcs2Driver::narrow_limits(const Axis& axis) {
  TableLimits::Range range{to_rad(axis.travel_min_deg), to_rad(axis.travel_max_deg)};
  if (const auto& own = axis.settings.limits) {
    range.min_rad = std::max(range.min_rad, own->min_rad);
    range.max_rad = std::min(range.max_rad, own->max_rad);
  }
  if (range.min_rad > range.max_rad) {
    fail_start(fmt::format("limits.{} leaves no travel: the controller allows {:.3f} to {:.3f} deg",
                           axis.settings.name, axis.travel_min_deg, axis.travel_max_deg),
               "correct the limits in the configuration");
    return;
  }
  travel(limits_, axis.settings.turns) = range;
}

// ---------------------------------------------------------------------------------------------- when it
// fails

void Gcs2Driver::fault(std::string what, std::string remedy) {
  emit(DeviceFault{now_, std::move(what), std::move(remedy)});
  halt();
  pump();
}

void Gcs2Driver::fail_start(std::string what, std::string remedy) {
  phase_ = Phase::waiting;
  queue_.clear();
  retry_.set(now_.mono, kGcs2Retry_s);
  set_state(LinkState::failed, what + "; " + remedy);
  if (std::exchange(last_start_fault_, what) != what)
    emit(DeviceFault{now_, std::move(what), std::move(remedy)});
}

void Gcs2Driver::give_up(const std::string& asked) {
  const std::string what = fmt::format("the table controller does not answer '{}' ({} attempts at {} Bd)",
                                       printable(asked), QueryQueue<Ask>::kAttempts, baud());
  const std::string remedy = "check power, cable and baud";
  phase_ = Phase::waiting;
  queue_.clear();
  send(kStop);
  retry_.set(now_.mono, kGcs2Retry_s);
  if (strange_.empty()) {
    set_state(LinkState::silent, what + "; " + remedy);
  } else {
    set_state(LinkState::failed,
              fmt::format("wrong device on the port? It says '{}', which answers nothing that it was asked; "
                          "check which device is on this port and its baud",
                          printable(strange_)));
    strange_.clear();
  }
  if (std::exchange(job_, Job::none) != Job::none)
    emit(DeviceFault{now_, what + ": the table cannot be reached and may still move", remedy});
}

void Gcs2Driver::report(bool moving) {
  emit(TableReading{now_, angles(), all_referenced(), moving, move_.arrived && !moving});
}

bool Gcs2Driver::all_referenced() const {
  return std::all_of(axes_.begin(), axes_.end(), [](const Axis& a) { return a.referenced; });
}

TableAngles Gcs2Driver::angles() const {
  TableAngles angles;
  for (const Axis& axis : axes_) {
    const double rad = to_rad(axis.position_deg);
    if (axis.settings.turns == Turns::azimuth) angles.azimuth_rad = rad;
    if (axis.settings.turns == Turns::pitch) angles.pitch_rad = rad;
    if (axis.settings.turns == Turns::roll) angles.roll_rad = rad;
  }
  return angles;
}

}  // namespace mgtd::drivers::gcs2
