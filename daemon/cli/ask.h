// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"
#include "daemon/serve/control_client.h"

namespace mgtd::cli {

/// One request to the daemon that `session` names: connect, ask, answer.
[[nodiscard]] Result<nlohmann::json> ask(const Session& session, ControlCommand command,
                                         nlohmann::json args = nlohmann::json::object());

}  // namespace mgtd::cli
