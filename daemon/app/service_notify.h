// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

#include "proto/time.h"

/// These functions report readiness and state to the service manager (sd_notify). Outside systemd every call
/// does nothing.
namespace mgtd::daemon::app {

void notify_ready();
void notify_stopping();
void notify_status(std::string_view one_line);
void notify_watchdog();
/// Half of WatchdogSec: how often notify_watchdog must be called; empty when no watchdog runs.
[[nodiscard]] std::optional<Duration> watchdog_period();

}  // namespace mgtd::daemon::app
