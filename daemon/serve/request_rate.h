// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>

#include "proto/time.h"

/// RequestRate limits how often a client may ask: `burst` requests at once, and `per_s` a second in the long
/// run.
namespace mgtd::daemon::serve {

struct RateLimit {
  double per_s{0};
  double burst{1};
};

class RequestRate {
 public:
  RequestRate(RateLimit limit, Instant now) : limit_(limit), left_(limit.burst), at_(now) {}

  /// One more request; false when it is one too many.
  [[nodiscard]] bool admit(Instant now) {
    left_ = std::min(limit_.burst, left_ + to_seconds(now - at_) * limit_.per_s);
    at_ = now;
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  RateLimit limit_;
  double left_;
  Instant at_;
};

}  // namespace mgtd::daemon::serve
