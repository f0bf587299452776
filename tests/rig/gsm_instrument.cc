// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/gsm_instrument.h"

#include <fmt/format.h>

#include <cmath>

namespace mgtd::rig {
namespace {

constexpr std::size_t kTuningDigits = 5;  ///< 048.5
constexpr std::size_t kClockDigits = 13;  ///< yymmddwHHMMSS
constexpr double kGsmBoot_s = 3;
constexpr double kSaturated_nT = 120'000;
constexpr const char* kMenu =
    "GSM-90 simulated v7.0\r\n5-50Hz 6-60Hz T-tuning C-time D-slower U-faster R-run\r\n";

}  // namespace

GsmInstrument::GsmInstrument(World& world, double utc_s)
    : world_(world), utc_s_(utc_s), period_s_(world.scenario().scalar_period_s) {}

void GsmInstrument::switched_off(double /*now_s*/) {
  running_ = false;
  digits_ = 0;
}

void GsmInstrument::switched_on(double now_s) {
  running_ = true;
  period_s_ = world_.scenario().scalar_period_s;
  next_s_ = now_s + kGsmBoot_s;
}

void GsmInstrument::receive(std::string_view bytes, double now_s) {
  if (!hears()) return;
  advance(now_s);
  for (const char c : bytes) menu(c, now_s);
}

void GsmInstrument::menu(char c, double now_s) {
  if (c == 'S') {
    running_ = false;
    digits_ = 0;
    return put(kMenu, now_s);
  }
  if (running_) return;
  if (digits_ > 0) {
    if (--digits_ == 0) put("set\r\n", now_s);
    return;
  }
  switch (c) {
    case '5':
    case '6':
      return put(fmt::format("filter {}0 Hz\r\n", c), now_s);
    case 'T':
      digits_ = kTuningDigits;
      return;
    case 'C':
      digits_ = kClockDigits;
      return put("yymmddwHHMMSS:\r\n", now_s);
    case 'D':
    case 'U':
      period_s_ *= c == 'D' ? 2.0 : 0.5;
      return put(fmt::format("every {} s\r\n", period_s_), now_s);
    case 'R':
      running_ = true;
      next_s_ = now_s + period_s_;
      return;
    default:
      return;
  }
}

void GsmInstrument::advance(double now_s) {
  for (; running_ && next_s_ <= now_s; next_s_ += period_s_) line(next_s_);
}

void GsmInstrument::line(double at_s) {
  if (!frozen_) last_nT_ = saturated_ ? kSaturated_nT : world_.read_scalar(at_s);
  const std::uint64_t bad_every = world_.scenario().scalar_bad_every;
  const bool bad = saturated_ || (bad_every > 0 && ++readings_ % bad_every == 0);
  const double second_of_day = std::fmod(utc_s_ + at_s, 86400.0);
  const auto whole = static_cast<long>(second_of_day);
  const double second = second_of_day - static_cast<double>(whole / 60 * 60);
  put(fmt::format("{:02}{:02}{:04.1f}  {:.2f} {}\r\n", whole / 3600, whole / 60 % 60,
                  std::floor(second * 10) / 10, last_nT_, bad ? "39" : "99"),
      at_s);
}

}  // namespace mgtd::rig
