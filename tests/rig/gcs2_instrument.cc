// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/gcs2_instrument.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace mgtd::rig {
namespace {

enum Gcs2Error : int {
  kSyntax = 1,
  kUnknownCommand = 2,
  kTooLong = 3,
  kNotReferenced = 5,
  kOutOfLimits = 7,
  kVelocity = 8,
  kStopped = 10,
  kInvalidAxis = 15,
  kOutOfRange = 17,
  kMissingParameter = 26,
  kMotionError = -1024
};

constexpr double kReferenceTravel_deg = 20;  ///< the way past the reference mark and back
constexpr double kMaxVelocity_deg_per_s = 720;
constexpr double kFactory_deg_per_s = 5;  ///< until it is told
constexpr double kEncoder_deg = 1e-4;     ///< sd of a position read
constexpr std::size_t kMaxGcs2Line = 255;
constexpr double kNever = 1e300;

TableAxis which(std::size_t i) { return static_cast<TableAxis>(i); }

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const std::size_t from = text.find_first_not_of(' ');
    if (from == std::string_view::npos) break;
    const std::size_t to = std::min(text.find(' ', from), text.size());
    out.push_back(text.substr(from, to - from));
    text.remove_prefix(to);
  }
  return out;
}

std::optional<double> number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string flag(bool on) { return on ? "1" : "0"; }
std::string decimal(double value) { return fmt::format("{:.7f}", value); }

}  // namespace

Gcs2Instrument::Gcs2Instrument(World& world) : world_(world), random_(world.scenario().seed ^ 0x6c5c'0002U) {}

void Gcs2Instrument::advance(double now_s) {
  for (Axis& axis : axes_) {
    if (axis.reference_done_s < 0 || now_s < axis.reference_done_s || jammed_) continue;
    axis.referenced = true;
    axis.reference_done_s = -1;
  }
  if (at_limit_ && world_.moving(now_s)) meet_limit(now_s);
  if (jammed_ == frozen_) return;
  jammed_ = frozen_;
  world_.set_jammed(jammed_, now_s);
}

void Gcs2Instrument::meet_limit(double now_s) {
  stop({0, 1, 2}, now_s);
  for (Axis& axis : axes_) axis.servo = false;
  error_ = kMotionError;
}

void Gcs2Instrument::switched_off(double now_s) {
  stop({0, 1, 2}, now_s);
  axes_ = {};
  line_.clear();
  error_ = 0;
  for (const std::size_t i : {0U, 1U, 2U}) world_.set_velocity(which(i), kFactory_deg_per_s);
}

double Gcs2Instrument::next_s() const {
  double next = kNever;
  for (const Axis& axis : axes_) {
    if (axis.reference_done_s >= 0) next = std::min(next, axis.reference_done_s);
  }
  return next;
}

void Gcs2Instrument::receive(std::string_view bytes, double now_s) {
  advance(now_s);
  if (!hears()) return;
  for (const char c : bytes) {
    if (c == '\x05' || c == '\x07' || c == '\x18') {
      immediate(c, now_s);
    } else if (c == '\n') {
      command(std::exchange(line_, {}), now_s);
    } else if (line_.size() <= kMaxGcs2Line) {
      line_ += c;
    }
  }
}

void Gcs2Instrument::immediate(char byte, double now_s) {
  if (byte == '\x18') return stop({0, 1, 2}, now_s);
  if (byte == '\x07') {
    const bool ready =
        std::all_of(axes_.begin(), axes_.end(), [](const Axis& a) { return a.reference_done_s < 0; });
    return put(ready ? "\xb1\n" : "\xb0\n", now_s);
  }
  unsigned mask = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) mask |= static_cast<unsigned>(busy(i, now_s)) << i;
  put(fmt::format("{:X}\n", mask), now_s);
}

bool Gcs2Instrument::busy(std::size_t axis, double now_s) const {
  return world_.axis(which(axis)).moving(now_s) || axes_.at(axis).reference_done_s >= 0;
}

void Gcs2Instrument::stop(const std::vector<std::size_t>& axes, double now_s) {
  for (const std::size_t i : axes) {
    world_.halt(which(i), now_s);
    axes_[i].reference_done_s = -1;
  }
  error_ = kStopped;
}

double Gcs2Instrument::limit_deg(std::size_t axis) const {
  return axis == azimuth ? 360 : world_.scenario().tilt_limit_deg;
}

std::optional<std::vector<std::size_t>> Gcs2Instrument::axes_named(std::string_view names) {
  std::vector<std::size_t> out;
  for (const std::string_view name : words(names)) {
    if (name.size() != 1 || name[0] < '1' || name[0] > '3') {
      error_ = kInvalidAxis;
      return std::nullopt;
    }
    out.push_back(static_cast<std::size_t>(name[0] - '1'));
  }
  if (out.empty()) out = {0, 1, 2};
  return out;
}

void Gcs2Instrument::command(std::string_view line, double now_s) {
  const std::size_t space = std::min(line.find(' '), line.size());
  const std::string_view verb = line.substr(0, space), rest = line.substr(space);
  if (verb.empty()) return;
  if (line.size() > kMaxGcs2Line) {
    error_ = kTooLong;
  } else if (verb == "*IDN?") {
    put("(c)2024 Physik Instrumente (PI) GmbH & Co. KG, C-867.simulated, 867001, 1.0\n", now_s);
  } else if (verb == "ERR?") {
    put(fmt::format("{}\n", std::exchange(error_, 0)), now_s);
  } else if (verb == "SAI?") {
    put("1 \n2 \n3\n", now_s);
  } else if (verb == "STP" || verb == "HLT") {
    if (const auto axes = axes_named(verb == "HLT" ? rest : std::string_view())) stop(*axes, now_s);
  } else if (verb.ends_with('?')) {
    query(verb, rest, now_s);
  } else if (verb == "FRF") {
    reference(rest, now_s);
  } else {
    assign(verb, rest, now_s);
  }
}

void Gcs2Instrument::query(std::string_view verb, std::string_view rest, double now_s) {
  const auto axes = axes_named(rest);
  if (!axes) return;
  std::string out;
  for (const std::size_t i : *axes) {
    const auto value = answer(verb, i, now_s);
    if (!value) {
      error_ = kUnknownCommand;
      return;
    }
    if (!out.empty()) out += " \n";
    out += fmt::format("{}={}", i + 1, *value);
  }
  put(out + "\n", now_s);
}

std::optional<std::string> Gcs2Instrument::answer(std::string_view verb, std::size_t i, double now_s) {
  const AxisMotion& motion = world_.axis(which(i));
  const Axis& axis = axes_.at(i);
  if (verb == "POS?") return decimal(motion.indicated_deg(now_s) + kEncoder_deg * encoder_(random_));
  if (verb == "MOV?") return decimal(axis.target_deg);
  if (verb == "ONT?") return flag(!busy(i, now_s) && axis.servo);
  if (verb == "FRF?") return flag(axis.referenced);
  if (verb == "SVO?") return flag(axis.servo);
  if (verb == "VEL?") return decimal(motion.velocity());
  if (verb == "TMN?") return decimal(-limit_deg(i));
  if (verb == "TMX?") return decimal(limit_deg(i));
  return std::nullopt;
}

void Gcs2Instrument::reference(std::string_view rest, double now_s) {
  const auto axes = axes_named(rest);
  if (!axes) return;
  if (std::any_of(axes->begin(), axes->end(), [&](std::size_t i) { return !axes_[i].servo; })) {
    error_ = kNotReferenced;
    return;
  }
  for (const std::size_t i : *axes) {
    const AxisMotion& motion = world_.axis(which(i));
    const double travel_deg = kReferenceTravel_deg + std::abs(motion.indicated_deg(now_s));
    world_.move(which(i), 0, now_s);
    axes_[i].referenced = false;
    axes_[i].target_deg = 0;
    axes_[i].reference_done_s = now_s + travel_deg / motion.velocity() + 1;
  }
}

void Gcs2Instrument::assign(std::string_view verb, std::string_view rest, double now_s) {
  if (verb != "SVO" && verb != "MOV" && verb != "VEL") {
    error_ = kUnknownCommand;
    return;
  }
  const std::vector<std::string_view> args = words(rest);
  int error = args.empty() || args.size() % 2 != 0 ? kMissingParameter : 0;
  std::vector<Assignment> all;
  for (std::size_t k = 0; error == 0 && k < args.size(); k += 2) {
    const auto axis = axes_named(args[k]);
    const auto value = number(args[k + 1]);
    if (!axis) return;
    all.push_back({axis->front(), value.value_or(0)});
    error = value ? refusal(verb, all.back()) : kSyntax;
  }
  if (error != 0) {
    error_ = error;
    return;
  }
  for (const Assignment& wanted : all) carry_out(verb, wanted, now_s);
}

int Gcs2Instrument::refusal(std::string_view verb, const Assignment& wanted) const {
  if (verb == "SVO") return wanted.value == 0 || wanted.value == 1 ? 0 : kOutOfRange;
  if (verb == "VEL") return wanted.value > 0 && wanted.value <= kMaxVelocity_deg_per_s ? 0 : kVelocity;
  const Axis& axis = axes_.at(wanted.axis);
  if (!axis.servo || !axis.referenced) return kNotReferenced;
  return std::abs(wanted.value) > limit_deg(wanted.axis) + 1e-9 ? kOutOfLimits : 0;
}

void Gcs2Instrument::carry_out(std::string_view verb, const Assignment& wanted, double now_s) {
  Axis& axis = axes_.at(wanted.axis);
  if (verb == "VEL") {
    world_.set_velocity(which(wanted.axis), wanted.value);
  } else if (verb == "MOV") {
    axis.target_deg = wanted.value;
    const double here_deg = world_.axis(which(wanted.axis)).indicated_deg(now_s);
    const double limit = limit_deg(wanted.axis);
    world_.move(which(wanted.axis),
                backwards_ ? std::clamp(2 * here_deg - wanted.value, -limit, limit) : wanted.value, now_s);
  } else {
    axis.servo = wanted.value != 0;
    if (axis.servo) return;
    // Without servo nothing drives it on.
    if (busy(wanted.axis, now_s)) world_.halt(which(wanted.axis), now_s);
    axis.reference_done_s = -1;
  }
}

}  // namespace mgtd::rig
