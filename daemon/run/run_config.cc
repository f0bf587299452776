// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_config.h"

#include "calib/fit/joint/joint_fit.h"
#include "daemon/config/config.h"

namespace mgtd::daemon::run {

RunConfig run_config(const config::Config& config, const drivers::TableLimits& limits) {
  RunConfig out;
  out.sensors = config.geometry().sensors();
  out.fewest_poses = calib::fit::joint::kFewestPoses;
  out.limits = limits;
  out.preflight.length_s = config.run.preflight_s;
  out.preflight.field_nT = config.site.field_nT;
  out.preflight.scalar = config.scalar.has_value();
  out.preflight.rate_hz = out.settle.rate_hz = out.dwell.rate_hz = config.rate_hz;
  out.settle.min_s = config.run.settle_min_s;
  out.settle.max_s = config.run.settle_max_s;
  out.disturbance = {.limit_nT = config.run.disturbance_nT, .false_alarm = config.run.false_alarm};
  out.field_step_nT = config.run.field_step_nT;
  out.calm_s = config.run.calm_s;
  out.wait.calm_max_s = config.run.calm_max_s;
  out.retries = config.run.retries;
  // A sped-up clock makes the host's own delays longer: 1 ms of scheduling or disk is that many ms of the
  // rig's time. What the clocks then show is the host, not the rig.
  if (config.speed_up > 1) out.preflight.max_skew_s = 60;
  for (double* limit : {&out.preflight.wait_s, &out.wait.store_max_s, &out.wait.judge_max_s,
                        &out.wait.solve_max_s, &out.wait.stop_max_s, &out.dwell.grace_s}) {
    *limit *= config.speed_up;
  }
  out.by_hand = config.by_hand();
  out.wait.answer_max_s = config.run.answer_max_s * config.speed_up;  // hands and eyes keep their own time
  return out;
}

}  // namespace mgtd::daemon::run
