// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "proto/time.h"

/// The wall clock of a run is the host's, read once where the run begins or is taken up; from there on time
/// passes as the monotonic clock says. A host's clock that is set during the run moves no pose.
namespace mgtd::daemon::run {

[[nodiscard]] inline WallTime wall_in_run(const Stamp& run_start, Instant t) {
  return {run_start.wall.ns + (t - run_start.mono).count()};
}

}  // namespace mgtd::daemon::run
