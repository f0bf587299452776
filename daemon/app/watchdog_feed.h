// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "proto/time.h"

/// WatchdogFeed decides when the service manager is told that all is well: only while the data path moves.
/// Epochs, or honest gaps, must have come out since the last time; before the first epoch there is nothing
/// that could. Pure, and asked once a second: an event loop that hangs does not ask, and one that lives on
/// while the data stand still gets no.
namespace mgtd::daemon::app {

class WatchdogFeed {
 public:
  /// `period`: the longest time between two words; half of it is kept.
  explicit WatchdogFeed(Duration period) : period_(period) {}

  /// `published`: epochs and gaps that came out so far; `epochs`: those of them that were measured.
  [[nodiscard]] bool is_due(std::uint64_t published, std::uint64_t epochs, Instant now) {
    const bool moved = epochs == 0 || published != published_;
    if (!moved || now < next_) return false;
    next_ = now + period_ / 2;
    published_ = published;
    return true;
  }

 private:
  Duration period_;
  Instant next_{Instant::min()};
  std::uint64_t published_{0};
};

}  // namespace mgtd::daemon::app
