// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "proto/time.h"

/// These functions write the service's log to journald or stderr.
namespace mgtd::daemon::app {

/// Level: debug, info, warn, error. Under systemd lines carry no time of their own: the journal stamps them.
void start_log(std::string_view level);

/// What repeats is written when it first comes, then at most once a minute with a count. A device that comes
/// and goes says something else each time: of one topic no more than kLinesAMinute are written, and the last
/// of those held back when the minute is over.
class QuietLog {
 public:
  static constexpr int kLinesAMinute = 12;

  /// `topic` decides what counts as the same source, e.g. "s2".
  void warn(std::string_view topic, std::string_view message, Instant now);
  void info(std::string_view topic, std::string_view message, Instant now);
  /// To be called every second or so.
  void tick(Instant now);

 private:
  struct Topic {
    std::string message, held;  ///< last written, last held back
    Instant written, minute;    ///< when, and where the minute began
    int lines{0};               ///< in it
    std::uint64_t held_back{0};
    bool held_warning{false};
  };
  void say(bool warning, std::string_view topic, std::string_view message, Instant now);
  static void write(bool warning, std::string_view name, Topic& topic, std::string_view message, Instant now);

  std::map<std::string, Topic, std::less<>> topics_;
};

}  // namespace mgtd::daemon::app
