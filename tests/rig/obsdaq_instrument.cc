// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/obsdaq_instrument.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>

namespace mgtd::rig {
namespace {

constexpr int kQuickStop = 22;  ///< bars in a row that stop an acquisition
constexpr double kTick_s = 64 / 9.8304e6;
constexpr double kSlow = 1.01;  ///< of its seconds, by the fault
constexpr double kFullCount = 8388608.0;
constexpr std::int64_t kMaxCount = 8388607;
constexpr double kSensor_V = 10;  ///< of the analogue fluxgate at full scale
constexpr double kSelfCalibration_s = 1.5;
constexpr std::size_t kMaxLine = 64;
constexpr double kBoot_s = 1;
constexpr const char* kFactorySetup = "0333";  ///< +-5 V
constexpr const char* kRefused = "?01";

/// Two's complement hex of so many digits.
std::string hex(std::int64_t value, int digits) {
  const std::int64_t modulus = std::int64_t{1} << (4 * digits);
  return fmt::format("{:0{}X}", ((value % modulus) + modulus) % modulus, digits);
}

std::optional<unsigned> from_hex(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

double volts_of_code(std::string_view ccdd) {
  const std::string_view cc = ccdd.substr(0, 2);
  return cc == "02" ? 10.0 : cc == "03" ? 5.0 : 2.5;
}

}  // namespace

ObsdaqInstrument::ObsdaqInstrument(World& world, int slot, double utc_s)
    : world_(world),
      slot_(slot),
      utc_s_(utc_s),
      palmacq_(world.scenario().palmacq),
      inputs_(on_digitiser(world.scenario().covariates, slot)) {
  // Spread over the allowed range so that no two agree.
  constexpr std::array<double, kMostPlaces> kShare{-1.0, 0.6,  -0.2, 1.0, -0.6, 0.2,  0.8, -0.8,
                                                   0.4,  -0.4, 0.1,  0.9, -0.9, -0.1, 0.5, -0.5};
  const Scenario& s = world.scenario();
  const auto i = static_cast<std::size_t>(slot);
  oscillator_ = s.common_trigger ? 1.0 : 1.0 + 1e-6 * s.oscillator_ppm * kShare.at(i);
  oscillator_ /= 1 + of_sensor(s.rate_error_percent, i) / 100;
}

double ObsdaqInstrument::period_s() const { return ticks_ * kTick_s * oscillator_ * (slow_ ? kSlow : 1); }

void ObsdaqInstrument::autostart(double now_s) {
  ticks_ = ticks_of(world_.scenario().rate_hz);
  forwarding_ = true;
  start_acquisition(now_s);
  put(sample_line(now_s).substr(9) + "\r", now_s);
}

unsigned ObsdaqInstrument::ticks_of(double rate_hz) const {
  return static_cast<unsigned>(std::lround(1 / (kTick_s * rate_hz)));
}

void ObsdaqInstrument::switched_off(double /*now_s*/) {
  acquiring_ = forwarding_ = transparent_ = escape_ = false;
  line_.clear();
  channels_ = {};
  ticks_ = 0;
}

/// One that starts by itself does so with what the maker thought of: another range and half the rate.
void ObsdaqInstrument::switched_on(double now_s) {
  if (!world_.scenario().autostart) return;
  for (Channel& channel : channels_) channel.setup = kFactorySetup;
  ticks_ = ticks_of(world_.scenario().rate_hz / 2);
  forwarding_ = true;
  start_acquisition(now_s + kBoot_s);
}

void ObsdaqInstrument::receive(std::string_view bytes, double now_s) {
  if (!hears()) return;
  advance(now_s);
  for (const char c : bytes) byte(c, now_s);
}

void ObsdaqInstrument::byte(char c, double now_s) {
  if (c == '\0') {
    escape_ = true;
    return;
  }
  if (std::exchange(escape_, false) && c == '\x1b') {
    transparent_ = false;
    line_.clear();
    return;
  }
  const bool to_obsdaq = !palmacq_ || transparent_;
  if (c == '|' && to_obsdaq) {
    if (++bars_ >= kQuickStop) acquiring_ = false;
    line_.clear();
    return;
  }
  bars_ = 0;
  if (c != '\r') {
    if (line_.size() <= kMaxLine) line_ += c;
    return;
  }
  const std::string line = std::exchange(line_, {});
  if (to_obsdaq) {
    obsdaq_line(line, now_s);
  } else {
    palmacq_line(line, now_s);
  }
}

void ObsdaqInstrument::palmacq_line(std::string_view line, double now_s) {
  if (line == "SM:TRP") {
    put("AM:TRP,001B\r", now_s);
    transparent_ = true;
  } else if (line == "SF:R") {
    forwarding_ = true;
  } else if (line == "SF:-") {
    forwarding_ = false;
  } else if (line == "GV") {
    put("palmAcq simulated\rV1.0\r", now_s);
  }
}

void ObsdaqInstrument::obsdaq_line(std::string_view line, double now_s) {
  if (line.size() < 3 || (line[0] != '$' && line[0] != '#') || line.substr(1, 2) != "01") return;
  if (line == "#01ST") {
    acquiring_ = false;
    return;
  }
  if (acquiring_) return;
  const std::string_view command = line.substr(3);
  put((line[0] == '$' ? dollar(command, now_s) : hash(command, now_s)) + "\r", now_s);
}

std::string ObsdaqInstrument::hash(std::string_view command, double now_s) {
  if (command == "CS" && ticks_ > 0) {
    start_acquisition(now_s);
    return "!01";
  }
  if (!command.starts_with("PP") || command.size() != 10) return kRefused;
  const auto period = from_hex(command.substr(2, 4));
  if (!period || !from_hex(command.substr(6))) return kRefused;
  ticks_ = *period;
  return fmt::format("!01{}", command.substr(2));
}

std::string ObsdaqInstrument::dollar(std::string_view command, double now_s) {
  if (command == "M") return "!01<obsDAQ V5.5.7>";
  if (command == "F") return "!01V5.5.7 2018-06-01";
  if (command == "SN" && world_.scenario().tells_serial) return fmt::format("!01SN{:04}", 1001 + slot_);
  if (command == "2") return "!0107";
  if (command == "QF") return "!01R98";
  if (command == "IR0") return world_.scenario().autostart ? "!01#01CS" : "!01*ERR";
  if (command.size() >= 3 && command[0] >= '0' && command[0] <= '2')
    return channel_command(channels_.at(static_cast<std::size_t>(command[0] - '0')), command.substr(1),
                           now_s);
  return kRefused;
}

std::string ObsdaqInstrument::channel_command(Channel& channel, std::string_view command, double now_s) {
  if (command.starts_with("WS0201") && command.size() == 10) {
    const std::string_view cc = command.substr(6, 2);
    if ((cc != "02" && cc != "03" && cc != "04") || !from_hex(command.substr(8))) return kRefused;
    channel.setup = command.substr(6);
    return "!010201" + channel.setup;
  }
  if (command == "RS") return "!010201" + channel.setup;
  if (command == "RO") return "!01" + channel.offset;
  if (command == "RF") return "!01" + channel.full_scale;
  if (command == "RR") return now_s < channel.calibrated_s ? "!01R1" : "!01R0";
  const std::string_view value = command.substr(2);
  if (command.starts_with("WCF") && command.size() == 4) {
    channel.calibrated_s = now_s + kSelfCalibration_s;
    return fmt::format("!01{}", value);
  }
  if (value.size() != 6 || !from_hex(value)) return kRefused;
  if (command.starts_with("WO")) {
    channel.offset = value;
  } else if (command.starts_with("WF")) {
    channel.full_scale = value;
  } else {
    return kRefused;
  }
  return fmt::format("!01{}", value);
}

void ObsdaqInstrument::start_acquisition(double now_s) {
  acquiring_ = true;
  // The first sample comes a filter time later. A common trigger has one phase for all; otherwise each has
  // its own.
  if (world_.scenario().common_trigger) {
    next_sample_s_ = (std::floor(now_s / period_s()) + 2) * period_s();
  } else {
    next_sample_s_ = now_s + (1 + 0.23 * slot_) * period_s();
  }
  next_supplement_s_ = next_sample_s_;
}

void ObsdaqInstrument::advance(double now_s) {
  while (acquiring_ && next_sample_s_ <= now_s) {
    const double t = next_sample_s_;
    next_sample_s_ += period_s();
    std::string line = sample_line(t);
    if (t >= next_supplement_s_) {
      line += supplement(t);
      next_supplement_s_ += 1.0;
    }
    if (palmacq_ && !transparent_) {
      if (!forwarding_) continue;
      line = time_prefix(t) + line;
    }
    put(line + "\r", t);
  }
}

std::string ObsdaqInstrument::sample_line(double t_s) {
  const Eigen::Vector3d y_nT = world_.read_sensor(slot_, t_s);
  if (!frozen_) last_y_nT_ = y_nT;
  std::string line = "*";
  for (int a = 0; a < 3; ++a) {
    const double range_V = volts_of_code(channels_.at(static_cast<std::size_t>(a)).setup);
    const double volts = last_y_nT_[a] / (world_.scenario().uT_full_scale * 1000) * kSensor_V;
    const double sign = std::copysign(1.0, volts);
    const auto count =
        saturated_ ? std::llround(sign * 2 * kFullCount) : std::llround(volts / range_V * kFullCount);
    line += hex(std::clamp<std::int64_t>(count, -kMaxCount - 1, kMaxCount), 6);
  }
  return line + "L";
}

/// Supply 12.3 V; electronics 5 degrees warmer than the head; the head on input p at 0.1 V per degree; on q
/// and r what the scenario puts there.
std::string ObsdaqInstrument::supplement(double t_s) const {
  const double head = world_.head_degC(slot_, t_s);
  const auto supply = std::llround((12.3 - 9.15) / 2.6622e-3);
  const auto electronics = std::llround((head + 5) * 128);
  std::array<double, 3> inputs_V{head * 0.1, 0, 0};
  for (const Covariate& c : inputs_)
    inputs_V.at(static_cast<std::size_t>(c.input->letter - 'p')) =
        (c.at(t_s) - c.input->at_0V) / c.input->per_V;
  std::string out = ":" + hex(supply, 4) + hex(electronics, 4);
  for (const double volts : inputs_V)
    out += hex(std::clamp<std::int64_t>(std::llround(volts * 8000), -32768, 32767), 4);
  return out;
}

std::string ObsdaqInstrument::time_prefix(double t_s) const {
  using namespace std::chrono;
  const auto since = sys_time<milliseconds>(milliseconds(std::llround((utc_s_ + t_s) * 1000)));
  const auto day = floor<days>(since);
  const year_month_day date{day};
  const hh_mm_ss time{since - day};
  return fmt::format(":R,00,{:02}{:02}{:02}.{:02}{:02}{:02}.{:03},", static_cast<int>(date.year()) % 100,
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     time.hours().count(), time.minutes().count(), time.seconds().count(),
                     time.subseconds().count());
}

}  // namespace mgtd::rig
