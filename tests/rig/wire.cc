// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/wire.h"

#include <algorithm>

namespace mgtd::rig {
namespace {

constexpr std::size_t kGarbageBytes = 200;
constexpr std::uint64_t kTornOneIn = 100;

}  // namespace

void Wire::push(std::string bytes) {
  if (torn_) std::erase_if(bytes, [&](char) { return random_() % kTornOneIn == 0; });
  queue_ += bytes;
}

std::string Wire::pull(double now_s) {
  const double elapsed = std::max(0.0, now_s - last_s_);
  last_s_ = now_s;
  // An idle line saves nothing up.
  credit_ = queue_.empty() ? 0 : credit_ + elapsed * bytes_per_s_;
  const std::size_t n = std::min(queue_.size(), static_cast<std::size_t>(credit_));
  credit_ -= static_cast<double>(n);
  std::string out = queue_.substr(0, n);
  queue_.erase(0, n);
  return out;
}

void Wire::garbage() {
  for (std::size_t i = 0; i < kGarbageBytes; ++i) queue_ += static_cast<char>(random_() & 0xffU);
}

}  // namespace mgtd::rig
