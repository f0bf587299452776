// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/ask.h"

#include <nlohmann/json.hpp>

namespace mgtd::daemon::cli {

Result<nlohmann::json> ask(const Session& session, ControlCommand command, nlohmann::json args) {
  auto client = serve::ControlClient::connect(session.control_socket);
  if (!client) return tl::unexpected(client.error());
  return client->request(command, std::move(args));
}

}  // namespace mgtd::daemon::cli
