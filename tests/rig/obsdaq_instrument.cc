// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/obsdaq_instrument.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdint>

namespace mgtd::rig {
namespace {

constexpr int kQuickStop = 22;  ///< bars in a row that stop an acquisition
constexpr double kFullCount = 8388608.0;
constexpr std::int64_t kMaxCount = 8388607;

/// Two's complement hex of so many bits.
std::string hex(std::int64_t value, int digits) {
  const std::int64_t modulus = std::int64_t{1} << (4 * digits);
  return fmt::format("{:0{}X}", ((value % modulus) + modulus) % modulus, digits);
}

double volts_of_code(std::string_view cc) { return cc == "02" ? 10.0 : cc == "03" ? 5.0 : 2.5; }

}  // namespace

ObsdaqInstrument::ObsdaqInstrument(World& world, int slot, double utc_s)
    : world_(world), slot_(slot), utc_s_(utc_s), palmacq_(world.scenario().palmacq) {
  // Spread over the allowed range so that no two of the four agree.
  constexpr std::array<double, 4> kShare{-1.0, 0.6, -0.2, 1.0};
  const Scenario& s = world.scenario();
  oscillator_ =
      s.common_trigger ? 1.0 : 1.0 + 1e-6 * s.oscillator_ppm * kShare.at(static_cast<std::size_t>(slot));
}

void ObsdaqInstrument::autostart(double now_s) {
  ticks_ = static_cast<unsigned>(std::lround(9.8304e6 / 64 / world_.scenario().rate_hz));
  forwarding_ = true;
  start_acquisition(now_s);
}

void ObsdaqInstrument::receive(std::string_view bytes, double now_s) {
  if (silent_) return;
  advance(now_s);
  for (const char c : bytes) {
    if (palmacq_ && transparent_) {
      if (escape_ && c == '\x1b') {
        transparent_ = escape_ = false;
        line_.clear();
        continue;
      }
      escape_ = c == '\0';
      if (escape_) continue;
    } else if (c == '\0' || c == '\x1b') {
      continue;
    }
    const bool to_obsdaq = !palmacq_ || transparent_;
    if (c == '|' && to_obsdaq) {
      if (++bars_ >= kQuickStop) acquiring_ = false;
      line_.clear();
      continue;
    }
    bars_ = 0;
    if (c != '\r') {
      line_ += c;
      continue;
    }
    const std::string line = std::exchange(line_, {});
    if (to_obsdaq) {
      obsdaq_line(line, now_s);
    } else {
      palmacq_line(line);
    }
  }
}

void ObsdaqInstrument::palmacq_line(std::string_view line) {
  if (line == "SM:TRP") {
    put("AM:TRP,001B\r");
    transparent_ = true;
  } else if (line == "SF:R") {
    forwarding_ = true;
  } else if (line == "SF:-") {
    forwarding_ = false;
  } else if (line == "GV") {
    put("palmAcq simulated\rV1.0\r");
  }
}

void ObsdaqInstrument::reply(std::string_view text) { put(fmt::format("{}\r", text)); }

void ObsdaqInstrument::obsdaq_line(std::string_view line, double now_s) {
  if (line.size() < 3 || (line[0] != '$' && line[0] != '#') || line.substr(1, 2) != "01") return;
  const std::string_view command = line.substr(3);
  if (line == "#01ST") {
    acquiring_ = false;
    return;
  }
  if (acquiring_) return;
  if (line[0] == '#' && command.starts_with("PP") && command.size() == 10) {
    const std::string_view digits = command.substr(2);
    if (digits.find_first_not_of("0123456789ABCDEFabcdef") != std::string_view::npos) return reply("?01");
    ticks_ = static_cast<unsigned>(std::stoul(std::string(digits.substr(0, 4)), nullptr, 16));
    reply(fmt::format("!01{}", digits));
  } else if (line[0] == '#' && command == "CS" && ticks_ > 0) {
    reply("!01");
    start_acquisition(now_s);
  } else if (line[0] == '$' && command == "M") {
    reply("!01<obsDAQ V5.5.7>");
  } else if (line[0] == '$' && command.size() == 11 && command.substr(1, 6) == "WS0201" &&
             command[0] >= '0' && command[0] <= '2') {
    channel_.at(static_cast<std::size_t>(command[0] - '0')) = command.substr(7);
    reply(fmt::format("!010201{}", command.substr(7)));
  } else if (line[0] == '$' && command.size() == 3 && command.substr(1) == "RS" && command[0] >= '0' &&
             command[0] <= '2') {
    reply(fmt::format("!010201{}", channel_.at(static_cast<std::size_t>(command[0] - '0'))));
  } else {
    reply("?01");
  }
}

void ObsdaqInstrument::start_acquisition(double now_s) {
  acquiring_ = true;
  // The first sample comes a filter time later; the phase differs from device to device unless they share a
  // trigger.
  const double phase = world_.scenario().common_trigger ? 0.0 : 0.23 * slot_ * period_s();
  next_sample_s_ = now_s + period_s() + phase;
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
    put(line + "\r");
  }
}

std::string ObsdaqInstrument::sample_line(double t_s) {
  if (!frozen_) last_y_nT_ = world_.read_sensor(slot_, t_s);
  std::string line = "*";
  for (int a = 0; a < 3; ++a) {
    const double range =
        volts_of_code(std::string_view(channel_.at(static_cast<std::size_t>(a))).substr(0, 2));
    const double volts = last_y_nT_[a] / (world_.scenario().uT_full_scale * 1000) * world_.scenario().range_V;
    const auto count = std::llround(volts / range * kFullCount);
    line += hex(std::clamp<std::int64_t>(count, -kMaxCount - 1, kMaxCount), 6);
  }
  return line + "L";
}

/// Supply 12.3 V; electronics 5 degrees warmer than the head; the head on input p at 0.1 V per degree.
std::string ObsdaqInstrument::supplement(double t_s) const {
  const double head = world_.head_degC(slot_, t_s);
  const auto supply = std::llround((12.3 - 9.15) / 2.6622e-3);
  const auto electronics = std::llround((head + 5) * 128);
  const auto p = std::llround(head * 0.1 * 8000);
  return ":" + hex(supply, 4) + hex(electronics, 4) + hex(p, 4) + "00000000";
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
