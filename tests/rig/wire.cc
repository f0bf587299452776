// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/wire.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mgtd::rig {
namespace {

constexpr std::size_t kGarbageBytes = 200;
constexpr std::uint64_t kTornOneIn = 100;
constexpr double kLeastLate_s = 0.4, kMostLate_s = 2;
/// A byte is there when its end is reached to within rounding.
constexpr double kRounding = 1e-6;

}  // namespace

void Wire::push(Utterance said) {
  if (late_) said.at_s += std::uniform_real_distribution<double>(kLeastLate_s, kMostLate_s)(random_);
  if (half_ && ++pushed_ % 2 == 0) said.bytes.resize(said.bytes.size() / 2);
  if (swapped_ && held_.empty()) {
    held_ = std::move(said.bytes);
    return;
  }
  said.bytes += std::exchange(held_, {});
  if (twice_) carry(said);
  carry(std::move(said));
}

void Wire::set_swapped(bool swapped) {
  swapped_ = swapped;
  if (!swapped && !held_.empty()) carry({free_s_, std::exchange(held_, {})});
}

void Wire::carry(Utterance said) {
  const double begin_s = std::max(free_s_, said.at_s);
  free_s_ = begin_s + static_cast<double>(said.bytes.size()) * byte_s_;
  if (torn_) std::erase_if(said.bytes, [&](char) { return random_() % kTornOneIn == 0; });
  if (!said.bytes.empty()) bursts_.push_back({begin_s, std::move(said.bytes)});
}

std::string Wire::pull(double now_s) {
  if (step_s_ > 0) now_s = phase_s_ + step_s_ * std::floor((now_s - phase_s_) / step_s_ + kRounding);
  std::string out;
  while (!bursts_.empty()) {
    Burst& first = bursts_.front();
    const double arrived = std::floor((now_s - first.begin_s) / byte_s_ + kRounding);
    if (arrived < 1) break;
    const std::size_t n = std::min(first.bytes.size(), static_cast<std::size_t>(arrived));
    out.append(first.bytes, 0, n);
    if (n < first.bytes.size()) {
      first.bytes.erase(0, n);
      first.begin_s += static_cast<double>(n) * byte_s_;
      break;
    }
    bursts_.pop_front();
  }
  return out;
}

void Wire::garbage(double now_s) {
  std::string bytes(kGarbageBytes, '\0');
  for (char& c : bytes) c = static_cast<char>(random_() & 0xffU);
  push({now_s, std::move(bytes)});
}

void Wire::clear() {
  bursts_.clear();
  held_.clear();
  free_s_ = 0;
}

}  // namespace mgtd::rig
