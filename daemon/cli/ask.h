// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"
#include "daemon/serve/control_client.h"

namespace mgtd::daemon::cli {

/// ask() sends one request to the daemon that `session` names and returns its answer.
[[nodiscard]] Result<nlohmann::json> ask(const Session& session, ControlCommand command,
                                         nlohmann::json args = nlohmann::json::object());

}  // namespace mgtd::daemon::cli
