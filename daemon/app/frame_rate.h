// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "proto/time.h"

/// FrameRate tells how many good frames a second a device sends, over the last ten looks at its count. One
/// look a second: an instrument that speaks every third second still has a rate. Pure.
namespace mgtd::daemon::app {

class FrameRate {
 public:
  /// `frames`: all so far. `at`: the rig's time.
  void add(std::uint64_t frames, Instant at) {
    constexpr std::size_t kLooks = 11;
    looks_.push_back({frames, at});
    if (looks_.size() > kLooks) looks_.pop_front();
  }
  /// Empty until there are two looks.
  [[nodiscard]] std::optional<double> rate_hz() const {
    if (looks_.size() < 2 || looks_.back().at <= looks_.front().at) return std::nullopt;
    return static_cast<double>(looks_.back().frames - looks_.front().frames) /
           to_seconds(looks_.back().at - looks_.front().at);
  }

 private:
  struct Look {
    std::uint64_t frames;
    Instant at;
  };
  std::deque<Look> looks_;
};

}  // namespace mgtd::daemon::app
