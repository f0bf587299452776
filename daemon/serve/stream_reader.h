// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "daemon/serve/line_stream.h"
#include "proto/error.h"
#include "proto/watch_request.h"

/// A StreamReader is the operator's side of the live stream: it waits for the greeting, sends its watch, and
/// reads one object after the other.
namespace mgtd::daemon::serve {

class StreamReader {
 public:
  /// `where` is a Unix socket's path (it holds a '/') or a TCP address. Refuses a greeting that is none, or
  /// that does not come within `wait`, and a daemon whose protocol has another major version.
  [[nodiscard]] static Result<StreamReader> open(const std::string& where, const WatchRequest& request,
                                                 Duration wait = std::chrono::seconds(5));

  /// The next line as it came; empty when none came within `wait`.
  [[nodiscard]] Result<std::optional<std::string>> next_line(Duration wait) {
    return stream_.read_line(wait);
  }
  /// The next object; an ERROR object from the daemon is returned as an error.
  [[nodiscard]] Result<std::optional<nlohmann::json>> next(Duration wait);

  [[nodiscard]] const nlohmann::json& greeting() const { return greeting_; }

 private:
  explicit StreamReader(LineStream stream) : stream_(std::move(stream)) {}

  LineStream stream_;
  nlohmann::json greeting_;
};

}  // namespace mgtd::daemon::serve
