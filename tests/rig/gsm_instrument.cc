// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/gsm_instrument.h"

#include <fmt/format.h>

#include <cmath>

namespace mgtd::rig {
namespace {

constexpr double kPeriod_s = 1.0;
constexpr const char* kMenu = "GSM-90 simulated\r\nA-survey  B-info  C-time  D-slower  R-run\r\n";

}  // namespace

void GsmInstrument::receive(std::string_view bytes, double now_s) {
  if (silent_) return;
  advance(now_s);
  for (const char c : bytes) {
    if (c == 'S') {
      running_ = false;
      put(kMenu);
    } else if (c == 'R' && !running_) {
      running_ = true;
      next_s_ = now_s + kPeriod_s;
    }
  }
}

void GsmInstrument::advance(double now_s) {
  while (running_ && next_s_ <= now_s) {
    if (!frozen_) last_nT_ = world_.read_scalar(next_s_);
    const double second_of_day = std::fmod(utc_s_ + next_s_, 86400.0);
    const auto whole = static_cast<long>(second_of_day);
    put(fmt::format("{:02}{:02}{:04.1f}  {:.2f} 99\r\n", whole / 3600, whole / 60 % 60,
                    std::floor((second_of_day - static_cast<double>(whole / 60 * 60)) * 10) / 10, last_nT_));
    next_s_ += kPeriod_s;
  }
}

}  // namespace mgtd::rig
