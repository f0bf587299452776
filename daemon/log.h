// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <string_view>

#include "proto/time.h"

/// What the service writes to journald or stderr.
namespace mgtd::daemon {

/// Level: debug, info, warn, error. Under systemd lines carry no time of their own: the journal stamps them.
void start_log(std::string_view level);

/// A complaint that repeats is written when it first comes, then at most once a minute with a count.
class QuietLog {
 public:
  /// `topic` decides what counts as the same complaint, e.g. "s2".
  void warn(std::string_view topic, std::string_view message, Instant now);

 private:
  struct Last {
    std::string message;
    Instant written;
    std::uint64_t held_back{0};
  };
  std::map<std::string, Last, std::less<>> topics_;
};

}  // namespace mgtd::daemon
