// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/service_notify.h"

#include <systemd/sd-daemon.h>

#include <string>

namespace mgtd::daemon::app {

void notify_ready() { sd_notify(0, "READY=1"); }
void notify_stopping() { sd_notify(0, "STOPPING=1"); }
void notify_status(std::string_view one_line) { sd_notify(0, ("STATUS=" + std::string(one_line)).c_str()); }
void notify_watchdog() { sd_notify(0, "WATCHDOG=1"); }

std::optional<Duration> watchdog_period() {
  std::uint64_t period_us = 0;
  if (sd_watchdog_enabled(0, &period_us) <= 0) return std::nullopt;
  return Duration{static_cast<std::int64_t>(period_us) * 1000 / 2};
}

}  // namespace mgtd::daemon::app
