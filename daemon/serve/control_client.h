// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/serve/line_stream.h"
#include "proto/control_codec.h"
#include "proto/error.h"

/// A ControlClient is the operator's side of the control socket: one request, one answer, one after the
/// other.
namespace mgtd::daemon::serve {

class ControlClient {
 public:
  [[nodiscard]] static Result<ControlClient> connect(const std::string& path);

  /// The daemon's result or its error; `unreachable` when no answer came within `wait`.
  [[nodiscard]] Result<nlohmann::json> request(ControlCommand command,
                                               nlohmann::json args = nlohmann::json::object(),
                                               Duration wait = std::chrono::seconds(10));

 private:
  explicit ControlClient(LineStream stream) : stream_(std::move(stream)) {}

  LineStream stream_;
  std::uint64_t next_id_{1};
};

}  // namespace mgtd::daemon::serve
