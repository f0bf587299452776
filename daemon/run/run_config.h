// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/plan/approach.h"
#include "daemon/plan/run_duration.h"
#include "daemon/run/dwell.h"
#include "daemon/run/field_disturbance.h"
#include "daemon/run/preflight.h"
#include "daemon/run/settle.h"
#include "drivers/device.h"
#include "proto/instrument_identity.h"
#include "proto/units.h"

/// RunConfig holds the settings of one calibration run, beside its plan; angles in radians, times in seconds.
namespace mgtd::daemon::config {
struct Config;
}  // namespace mgtd::daemon::config

namespace mgtd::daemon::run {

/// The longest that a run waits for something before it pauses, gives up or ends.
struct WaitLimits {
  double answer_max_s{900};  ///< for the operator's entry
  double calm_max_s{600};    ///< for the end of a disturbance
  double lost_max_s{120};    ///< for a device to come back
  double home_max_s{180};
  double stop_max_s{10};  ///< from abort to a table seen at rest
  double store_max_s{30};
  double judge_max_s{900};
  double solve_max_s{900};
};

struct RunConfig {
  std::string run_id;
  std::size_t sensors{kSensorCount};  ///< of the array
  drivers::TableLimits limits;
  PreflightConfig preflight;
  SettleConfig settle;  ///< noise_nT is replaced by what the preflight finds
  DwellConfig dwell;    ///< length_s is that of each planned pose
  plan::Pace pace;

  /// Measure no further pose once the tensor is known so well (nT/m, worst component); empty: the whole plan.
  std::optional<double> until_tensor_sd_nT_per_m;
  bool until_explained{false};  ///< judge the run when its plan is measured, and go on from there
  std::size_t fewest_poses{1};  ///< that a calibration needs: none is finished before
  int retries{3};               ///< of one pose, before the run pauses and asks
  double approach_rad{plan::kApproach_rad};  ///< overshoot that gives the azimuth its planned sense; 0: none
  double reach_rad{to_rad(1)};               ///< a table at rest further from its target has not reached it

  /// That the active calibration was made with; empty: it does not say, or there is none.
  std::vector<InstrumentIdentity> calibrated{};

  bool by_hand{false};  ///< the table is turned by hand: its scales are asked for

  DisturbanceLimits disturbance;  ///< the field while the table stands
  double field_step_nT{5};        ///< of the scalar reference from one pose to the next; 0: not looked at
  double calm_s{5};               ///< without a change of the field, after which a disturbance is over

  WaitLimits wait;
};

/// As the configuration wants it, on a table of these limits.
[[nodiscard]] RunConfig run_config(const config::Config& config, const drivers::TableLimits& limits);

}  // namespace mgtd::daemon::run
