// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "daemon/run/dwell.h"
#include "daemon/run/preflight.h"
#include "daemon/run/settle.h"
#include "proto/reading.h"
#include "proto/run_status.h"
#include "proto/time.h"

/// A Phase is what a calibration run is doing now, with what only this phase needs; run_fsm.h says which
/// phase follows which.
namespace mgtd::daemon::run {
namespace phase {

struct Preflighting {
  Preflight preflight;
};
struct Homing {};
struct Asking {};     ///< the operator, for what is set by hand
struct Approaching {  ///< an attitude before the target, so that the azimuth arrives in its planned sense
  TableAngles goal;
};
struct Moving {  ///< and settling
  TableAngles goal;
  Settle settle;
};
struct Dwelling {
  TableAngles goal;
  Dwell dwell;
  std::optional<Instant> on_target;        ///< since when the table was seen there
  std::vector<TableAngles> reported = {};  ///< by the table, during the dwell
};
struct Suspended {};  ///< until the field is calm
struct Storing {};
struct Paused {};   ///< until the operator says
struct Waiting {};  ///< for a lost device
struct Judging {};  ///< what the poses say, and which further ones would make it clearer
struct Solving {};
struct Proposing {
  std::string calibration_id, left_over;
};
struct Stopping {};  ///< aborted; the table is not yet seen at rest
struct Ended {
  RunState state;
  std::string proposed;  ///< calibration id when done
};

}  // namespace phase

using Phase =
    std::variant<phase::Preflighting, phase::Homing, phase::Asking, phase::Approaching, phase::Moving,
                 phase::Dwelling, phase::Suspended, phase::Storing, phase::Paused, phase::Waiting,
                 phase::Judging, phase::Solving, phase::Proposing, phase::Stopping, phase::Ended>;

/// As the operator is shown it.
[[nodiscard]] RunState state_of(const Phase& phase);
/// From the preflight to the last pose, or waiting for a device to go on with that.
[[nodiscard]] bool is_measuring(const Phase& phase);

}  // namespace mgtd::daemon::run
