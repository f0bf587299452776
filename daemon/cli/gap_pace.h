// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/time.h"

/// A GapPace decides when a gap that goes on is mentioned again: 10 s after it began, a minute after that,
/// then every ten minutes. A rig without power sends a GAP a second; nobody wants to read each of them.
namespace mgtd::daemon::cli {

class GapPace {
 public:
  void begin(Instant now) {
    due_ = now + from_seconds(10);
    mentioned_ = 0;
  }
  [[nodiscard]] bool due(Instant now) const { return now >= due_; }
  void mention(Instant now) { due_ = now + from_seconds(mentioned_++ == 0 ? 60 : 600); }

 private:
  Instant due_;
  int mentioned_{0};
};

}  // namespace mgtd::daemon::cli
