// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

namespace mgtd::daemon::cli {

/// InputLines reads what the operator types, line by line. A signal of `catch_interrupts` ends the wait for a
/// line at whatever moment it comes; a read of std::cin would miss one that comes just before it and wait for
/// the next key. For the only thread that reads `fd`, and whose signals these are.
class InputLines {
 public:
  explicit InputLines(int fd) : fd_(fd) {}

  /// The next line without its end. Empty at the end of the input, and when interrupted() is true.
  [[nodiscard]] std::optional<std::string> next();

 private:
  int fd_;
  std::string in_;  ///< read and not yet given
};

}  // namespace mgtd::daemon::cli
