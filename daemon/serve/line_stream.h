// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "proto/error.h"
#include "proto/time.h"

/// A LineStream is a blocking connection to the daemon, line by line, for the operator's tool. Every wait for
/// a line has a limit; to connect takes as long as the system allows.
namespace mgtd::daemon::serve {

class LineStream {
 public:
  /// `unreachable`, with what to look at, when nothing answers.
  [[nodiscard]] static Result<LineStream> connect_unix(const std::string& path);
  /// "127.0.0.1:7450"
  [[nodiscard]] static Result<LineStream> connect_tcp(const std::string& address);

  LineStream(LineStream&& other) noexcept;
  LineStream& operator=(LineStream&& other) noexcept;
  ~LineStream();

  [[nodiscard]] Result<void> send_line(std::string_view line);
  /// The next line without its end; empty when none came within `wait`, or when a signal came. `unreachable`
  /// when the daemon closed.
  [[nodiscard]] Result<std::optional<std::string>> read_line(Duration wait);

 private:
  LineStream(int fd, std::string where) : fd_(fd), where_(std::move(where)) {}

  int fd_{-1};
  std::string where_;
  std::string in_;
};

}  // namespace mgtd::daemon::serve
