// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/scenario_help.h"

#include "tests/rig/effect_list.h"

namespace mgtd::rig {
namespace {

constexpr const char* kScenarioHelp =
    R"(A scenario is a TOML file; every key has a default:
  [rig]          name, parameters (table3, table6: of the cross only; ideal, random), seed, baseline_m
  [array]        positions_m = [[x, y, z], ...]: 1 to 16 sensors s1, s2, ... on the platform, in the place of the cross
                 (four, s1 at +X, s2 at +Y, s3 at -X, s4 at -Y, baseline_m apart). A list [4] below then has one
                 value for each sensor, and s4 stands for the last
  [s1] .. [s4]   theta_deg phi_deg psi_deg cx cy cz ix_nT iy_nT iz_nT alpha_deg beta_deg gamma_deg, where they differ
                 from the named rig; mounting = "y -x z": where the sensor's x, y, z point on the platform
  [site]         f_nT, inclination_deg, declination_deg, drift_nT_per_h, diurnal_nT, diurnal_period_h,
                 record (usgs-bou-2016-01-18, quiet, or usgs-bou-2016-01-20, a storm), record_start_h
  [temperature]  start_degC, ramp_degC_per_h, head_degC = [4], pulse_degC, pulse_at_s, pulse_tau_s, pulse_head,
                 law = "calib1520": the measured temperature laws of four real fluxgates
  [sensors]      noise (gaussian, uniform, student; or ar, walk, flicker, quantised: gaussian with ar1_rho = 0.9,
                 walk_nT_per_sqrt_h = 1, flicker_nT_per_sqrt_hz = 0.02, mean_step_nT = 0.1 where the key itself is
                 absent), noise_nT (sd or half width of one sample), student_dof, ar1_rho, tells_n_eff, slow_nT,
                 slow_tau_s, spike_share, spike_nT, lsb_nT (of samples), mean_step_nT (of the means in a table),
                 wiring = [4], plugs = [4] (whose plug is in which port: [1, 4, 3, 2] are two exchanged ones),
                 tells_serial (false: digitisers that do not), copied = 2 (every connector carries sensor 2), apart (in a table the sensors did
                 not share their attitudes), rate_hz, range_V, uT_full_scale, palmacq, common_trigger, autostart,
                 oscillator_ppm, rate_error_percent = [4] (-1: that digitiser is 1 % slow), delivery_s = [4] (its
                 bytes come when a timer of this period ticks), delivery_ppm = [4] (by which the timer is slow)
  [visit]        noise, noise_nT, student_dof, rho, outlier_share, outlier_nT, cycle_nT, cycle_visits,
                 cycle_where: what coming back to a pose does not reproduce
  [table]        accuracy_deg, velocity_deg_per_s, acceleration_deg_per_s2, tilt_limit_deg,
                 hands = "mount" (one axis, the array is mounted by hand) or "table" (no motors)
  [scalar]       present, noise_nT, period_s, bad_every
  [reference]    vector = true: columns ref_x_nT ref_y_nT ref_z_nT ref_sd_nT in a table; sd_nT, misalignment_deg =
                 [rx, ry, rz] (R ref = b with R = Rz Ry Rx), frame = "platform" (fixed to what holds the sensors) or
                 "site" (still beside the table, at_m = [3] from the centre), angles (default: true with "site"),
                 scalar (whether f_nT is there too)
  [cage]         fields = "sphere" or "random", max_nT, poses: a coil cage makes the fields of the table, the array
                 stands still in it; needs [reference] vector = true. f_nT only where scalar = true
  [recording]    motion = "hand", "flight", "level" or "one-axis", rate_hz (10), duration_s (300), rest_s (5, at the
                 start and at the end), ar (correlation of neighbouring samples), angles (false), scalar (true):
                 one row for each sample
  [[fault]]      at_s, do = "unplug fluxgate2 for 3"
  [[vehicle]]    at_s, nearest_m, speed_m_per_s, stands_s, moment_Am2: passes, or stands for a while
  [[magnet]]     at_s, until_s, moment_Am2 = [3], at_m = [3]: put down near the array; stays without until_s
  [[gross]]      pose, poses, where, do = "off" (by nT), "stuck" or "saturated": readings of a table
  [[covariate]]  name, mean, amplitude, wave (toggle, sine, ramp), every_s, recorded, pattern; input = "s2.q", unit,
                 per_V, at_0V: on the auxiliary input of a digitiser instead of the input module
  [[effect]]     name and coefficients; where = all, s1 .. s4, s1.x .. s4.z (of the array's sensors; default all):
)";

}  // namespace

std::string scenario_help() {
  std::string out = kScenarioHelp;
  for (const std::string& line : effect_help()) out += "    " + line + "\n";
  return out +
         "Exit code: 0 done, 1 the rig refused, 2 usage or a scenario with mistakes, 3 no rig is running "
         "there.";
}

}  // namespace mgtd::rig
