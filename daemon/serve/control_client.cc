// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/control_client.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

namespace mgtd::daemon::serve {

Result<ControlClient> ControlClient::connect(const std::string& path) {
  auto stream = LineStream::connect_unix(path);
  if (!stream) return tl::unexpected(stream.error());
  return ControlClient(std::move(*stream));
}

Result<nlohmann::json> ControlClient::request(ControlCommand command, nlohmann::json args, Duration wait) {
  const std::uint64_t id = next_id_++;
  if (auto sent = stream_.send_line(encode(ControlRequest{command, std::move(args), id})); !sent) {
    return tl::unexpected(sent.error());
  }
  for (const auto end = std::chrono::steady_clock::now() + wait;;) {
    const auto line = stream_.read_line(end - std::chrono::steady_clock::now());
    if (!line) return tl::unexpected(line.error());
    if (!*line && std::chrono::steady_clock::now() < end) continue;  // a signal came
    if (!*line) {
      return fail(ErrorCode::unreachable,
                  fmt::format("the daemon did not answer {} within {:g} s", name(command), to_seconds(wait)),
                  "systemctl status mgtd says what it is doing");
    }
    const auto reply = parse_reply(**line);
    if (!reply) return tl::unexpected(reply.error());
    // An answer to a request that was given up comes late and is passed over; a refusal may have no id.
    if (reply->id == id || reply->id.is_null()) return reply->result;
  }
}

}  // namespace mgtd::daemon::serve
