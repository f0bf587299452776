// SPDX-License-Identifier: Apache-2.0
/// The service runs from its start to the signal that ends it: log, store, daemon, signals.
///
/// It holds the lock of the store directory for as long as it lives, tells systemd when it is ready and when
/// it stops, and ends on SIGINT, SIGTERM and SIGHUP (the last unless it is ignored, as under nohup). It does
/// not read the command line or the configuration; main_mgtd.cc does.
#pragma once

#include "daemon/config/config.h"
#include "proto/error.h"

namespace mgtd::daemon::app {

/// Returns when a signal has ended the service. An error says what kept it from starting: the store that
/// another daemon holds, a port, a socket.
Result<void> run_service(config::Config config);

}  // namespace mgtd::daemon::app
