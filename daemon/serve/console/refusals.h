// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "proto/time.h"

/// Refusals counts how often the console refused control or a computation: to wrong tokens, and to callers
/// from elsewhere.
///
/// Each is counted. The log hears of the first, and then at most once a minute, with how many there were
/// since its last line; so a program that guesses tokens fills no disk. Pure.
namespace mgtd::daemon::serve::console {

class Refusals {
 public:
  static constexpr double kBetweenLines_s = 60;

  /// Counts one; what the log shall say of it, if it is to hear of it.
  [[nodiscard]] std::optional<std::string> add(std::string_view from, std::string_view why, Instant now);
  [[nodiscard]] std::uint64_t total() const { return total_; }

 private:
  std::uint64_t total_{0}, reported_{0};
  std::optional<Instant> last_line_;
};

}  // namespace mgtd::daemon::serve::console
