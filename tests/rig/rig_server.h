// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "tests/rig/scenario.h"

/// Puts a rig on ptys and keeps it going: simulated time runs `speed_up` times the host's.
namespace mgtd::rig {

struct ServerOptions {
  std::string
      dir;  ///< gets the links fluxgate1 .. scalar, the fault socket and, when all is there, the file `ready`
  double speed_up{1};
};

/// Runs until SIGINT or SIGTERM, then removes what it made. Returns an exit code.
int serve(Scenario scenario, const ServerOptions& options);

/// Sends one fault line to the rig in `dir`; prints the answer. Exit code 0, 1 refused, 3 no rig there.
int send_fault(const std::string& dir, const std::string& line);

}  // namespace mgtd::rig
