// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "tests/rig/scenario.h"

/// This puts a rig on ptys and keeps it going: simulated time runs `speed_up` times the host's.
///
/// `dir` gets the links fluxgate1 .. fluxgate4, table, scalar, the socket fault.sock and, when all is there,
/// the file `ready` with the process number. A client of the socket sends one line, a fault (fault.h) or
/// "status", "field", "mount AZIMUTH PITCH ROLL" or "magnet ARM", and gets one line back: "ok", what is wrong
/// with it, or the answer as JSON.
namespace mgtd::rig {

struct ServerOptions {
  std::string dir;
  double speed_up{1};
};

/// Runs until SIGINT or SIGTERM, then removes what it made. Returns an exit code: 2 when the directory cannot
/// be used.
[[nodiscard]] int serve(Scenario scenario, const ServerOptions& options);

}  // namespace mgtd::rig
