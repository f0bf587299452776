// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/gcs2_instrument.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

namespace mgtd::rig {
namespace {

enum Gcs2Error : int {
  kSyntax = 1,
  kUnknownCommand = 2,
  kNotReferenced = 5,
  kOutOfLimits = 7,
  kVelocity = 8,
  kStopped = 10,
  kInvalidAxis = 15,
  kMissingParameter = 26
};

constexpr double kReferenceTravel_deg = 20;

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
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

void Gcs2Instrument::advance(double now_s) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].reference_done_s >= 0 && now_s >= axes_[i].reference_done_s) {
      axes_[i].referenced = true;
      axes_[i].reference_done_s = -1;
    }
    if (jam_pending_) {
      world_.axis(which(i)).jam(now_s);
    } else {
      world_.axis(which(i)).release(now_s);
    }
  }
}

void Gcs2Instrument::receive(std::string_view bytes, double now_s) {
  advance(now_s);
  if (silent_) return;
  for (const char c : bytes) {
    if (c == '\x05' || c == '\x07' || c == '\x18') {
      immediate(c, now_s);
    } else if (c == '\n') {
      command(std::exchange(line_, {}), now_s);
    } else {
      line_ += c;
    }
  }
}

void Gcs2Instrument::immediate(char byte, double now_s) {
  if (byte == '\x18') return stop_all(now_s);
  if (byte == '\x07') return put(referencing(now_s) ? "\xb0\n" : "\xb1\n");
  unsigned mask = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const bool moving = world_.axis(which(i)).moving(now_s) || axes_[i].reference_done_s >= 0;
    mask |= static_cast<unsigned>(moving) << i;
  }
  put(fmt::format("{:X}\n", mask));
}

bool Gcs2Instrument::referencing(double now_s) const {
  for (const Axis& axis : axes_) {
    if (axis.reference_done_s > now_s) return true;
  }
  return false;
}

void Gcs2Instrument::stop_all(double now_s) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    world_.axis(which(i)).halt(now_s);
    axes_[i].reference_done_s = -1;
  }
  error_ = kStopped;
}

double Gcs2Instrument::limit_deg(std::size_t axis) const {
  return axis == azimuth ? 360 : world_.scenario().tilt_limit_deg;
}

int Gcs2Instrument::axis_named(std::string_view name) {
  if (name.size() == 1 && name[0] >= '1' && name[0] <= '3') return name[0] - '1';
  error_ = kInvalidAxis;
  return -1;
}

void Gcs2Instrument::command(std::string_view line, double now_s) {
  const std::size_t space = std::min(line.find(' '), line.size());
  const std::string_view verb = line.substr(0, space), rest = line.substr(space);
  if (verb.empty()) return;
  if (verb == "*IDN?") return put("(c)2024 Physik Instrumente (PI) GmbH & Co. KG, C-867.simulated, 0, 1.0\n");
  if (verb == "ERR?") return put(fmt::format("{}\n", std::exchange(error_, 0)));
  if (verb == "SAI?") return put("1 \n2 \n3\n");
  if (verb == "STP" || verb == "HLT") return stop_all(now_s);
  if (verb.ends_with('?')) return query(verb, rest, now_s);
  set(verb, rest, now_s);
}

void Gcs2Instrument::query(std::string_view verb, std::string_view rest, double now_s) {
  std::vector<std::string_view> names = words(rest);
  if (names.empty()) names = {"1", "2", "3"};
  std::string out;
  for (const std::string_view name : names) {
    const int found = axis_named(name);
    if (found < 0) return;
    const auto i = static_cast<std::size_t>(found);
    const AxisMotion& motion = world_.axis(which(i));
    double value = 0;
    bool flag = true;
    if (verb == "POS?")
      value = motion.indicated_deg(now_s), flag = false;
    else if (verb == "ONT?")
      value = !motion.moving(now_s) && axes_[i].reference_done_s < 0;
    else if (verb == "FRF?")
      value = axes_[i].referenced;
    else if (verb == "SVO?")
      value = axes_[i].servo;
    else if (verb == "VEL?")
      value = motion.velocity(), flag = false;
    else if (verb == "TMN?")
      value = -limit_deg(i), flag = false;
    else if (verb == "TMX?")
      value = limit_deg(i), flag = false;
    else {
      error_ = kUnknownCommand;
      return;
    }
    if (!out.empty()) out += " \n";
    out += flag ? fmt::format("{}={:.0f}", name, value) : fmt::format("{}={:.7f}", name, value);
  }
  put(out + "\n");
}

void Gcs2Instrument::set(std::string_view verb, std::string_view rest, double now_s) {
  std::vector<std::string_view> args = words(rest);
  if (verb == "FRF") {
    if (args.empty()) args = {"1", "2", "3"};
    for (const std::string_view name : args) {
      const int i = axis_named(name);
      if (i < 0) return;
      Axis& axis = axes_.at(static_cast<std::size_t>(i));
      if (!axis.servo) {
        error_ = kNotReferenced;
        return;
      }
      AxisMotion& motion = world_.axis(which(static_cast<std::size_t>(i)));
      motion.move_to(0, now_s, world_.random());
      axis.referenced = false;
      axis.reference_done_s =
          now_s + (kReferenceTravel_deg + std::abs(motion.indicated_deg(now_s))) / motion.velocity() + 1;
    }
    return;
  }
  if (verb != "SVO" && verb != "MOV" && verb != "VEL") {
    error_ = kUnknownCommand;
    return;
  }
  if (args.empty() || args.size() % 2 != 0) {
    error_ = kMissingParameter;
    return;
  }
  for (std::size_t k = 0; k + 1 < args.size(); k += 2) {
    const int i = axis_named(args[k]);
    const auto value = number(args[k + 1]);
    if (i < 0) return;
    if (!value) {
      error_ = kSyntax;
      return;
    }
    const auto at = static_cast<std::size_t>(i);
    if (verb == "SVO") {
      axes_[at].servo = *value != 0;
      if (!axes_[at].servo) world_.axis(which(at)).halt(now_s);
    } else if (verb == "VEL") {
      if (*value <= 0 || *value > 720) {
        error_ = kVelocity;
        return;
      }
      world_.axis(which(at)).set_velocity(*value);
    } else {
      move(at, *value, now_s);
    }
  }
}

void Gcs2Instrument::move(std::size_t axis, double target_deg, double now_s) {
  if (!axes_[axis].servo || !axes_[axis].referenced) {
    error_ = kNotReferenced;
  } else if (std::abs(target_deg) > limit_deg(axis) + 1e-9) {
    error_ = kOutOfLimits;
  } else {
    world_.axis(which(axis)).move_to(target_deg, now_s, world_.random());
  }
}

}  // namespace mgtd::rig
