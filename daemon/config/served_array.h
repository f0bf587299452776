// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "daemon/config/config.h"
#include "proto/error.h"

/// Which arrays the service can drive: the cross of four sensors alone.
namespace mgtd::daemon::config {

/// Why mgtd does not run a rig with this array; empty where it does. Everything offline takes any array.
[[nodiscard]] std::optional<Error> not_served(const Config& config);

}  // namespace mgtd::daemon::config
