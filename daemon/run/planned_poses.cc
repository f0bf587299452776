// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/planned_poses.h"

#include <numbers>
#include <utility>

#include "daemon/plan/approach.h"
#include "daemon/plan/mounting.h"
#include "daemon/plan/run_duration.h"
#include "daemon/plan/run_plan.h"

namespace mgtd::daemon::run {
namespace {

/// Ends at `end_s`.
Pose pose_of(const plan::PlannedPose& planned, double end_s, int sense, const plan::Pace& pace) {
  Pose pose;
  pose.number = planned.number;
  pose.set = planned.set;
  pose.t_s = end_s - planned.dwell_s / 2;
  const TableAngles a =
      planned.mount ? plan::platform_angles(planned.mounting, planned.target) : planned.target;
  pose.azimuth_rad = a.azimuth_rad;
  pose.pitch_rad = a.pitch_rad;
  pose.roll_rad = a.roll_rad;
  pose.mount = planned.mount;
  pose.dwell_s = planned.dwell_s;
  pose.since_stop_s = pace.settle_s + planned.dwell_s / 2;
  if (sense != 0) pose.sense = sense;
  return pose;
}

}  // namespace

drivers::TableLimits table_limits(const config::Config& config) {
  constexpr double kHalfTurn = std::numbers::pi;
  const auto* const table = dynamic_cast<const drivers::Turntable*>(config.table.device.get());
  if (table != nullptr) return table->limits();
  return {.azimuth = {-kHalfTurn, kHalfTurn},
          .pitch = {-kHalfTurn / 2, kHalfTurn / 2},
          .roll = {-kHalfTurn, kHalfTurn}};
}

plan::PlanOptions plan_options(const config::Config& config) {
  const config::RunDefaults& d = config.run;
  return {.step_deg = d.step_deg,
          .random = d.random,
          .revisits = d.revisits,
          .dwell_short_s = d.dwell_short_s,
          .dwell_long_s = d.dwell_long_s,
          .seed = d.seed,
          .mounts = config.mounts,
          .by_hand = config.by_hand()};
}

Result<PoseTable> planned_poses(const config::Config& config) {
  const drivers::TableLimits limits = table_limits(config);
  if (limits.azimuth.max_rad <= limits.azimuth.min_rad)
    return fail(
        ErrorCode::refused,
        config.file +
            ": how far the table turns is not in the configuration; the daemon learns it from "
            "the controller",
        "state limits.azimuth, limits.pitch and limits.roll in [table], or ask the running daemon: mgt "
        "run dry-run");
  return planned_poses(plan_options(config), limits);
}

Result<PoseTable> planned_poses(const plan::PlanOptions& options, const drivers::TableLimits& limits) {
  const auto plan = plan::make_plan(options, limits);
  if (!plan) return tl::unexpected(plan.error());
  const plan::Pace pace;
  PoseTable out;
  double t_s = 0;
  TableAngles at;
  int sense = 0;
  for (std::size_t k = 0; k < plan->poses.size(); ++k) {
    const plan::PlannedPose& planned = plan->poses[k];
    const double begun_s = t_s;
    t_s += plan::pose_s(pace, *plan, k);
    const auto by_way_of =
        plan::waypoint(at, sense, planned.target, planned.sense, plan::kApproach_rad, limits);
    if (by_way_of && !planned.mount)
      out.path.push_back({begun_s + plan::move_s(pace, at, *by_way_of), *by_way_of});
    const int last = plan::sense_of(by_way_of.value_or(at).azimuth_rad, planned.target.azimuth_rad);
    if (last != 0) sense = last;
    at = planned.target;
    out.poses.push_back(pose_of(planned, t_s, sense, pace));
  }
  return out;
}

void assume(const config::Config& config, calib::design::DesignRequest& request) {
  request.candidates = reachable(config, std::move(request.candidates));
  request.geometry = config.geometry();
  request.table_sd_rad = to_rad(config.site.table_sd_deg);
  request.f_nT = config.site.field_nT.value_or(request.f_nT);
  if (!config.scalar) request.scalar_sd_nT = std::nullopt;
  request.field_known = config.site.field_nT.has_value();
  request.field_sd_nT = config.site.field_sd_nT;
  if (config.site.inclination_deg) request.inclination_rad = to_rad(*config.site.inclination_deg);
  if (config.site.declination_deg) request.declination_rad = to_rad(*config.site.declination_deg);
}

std::vector<TableAngles> reachable(const config::Config& config, std::vector<TableAngles> attitudes) {
  constexpr double kSlack_rad = 1e-9;
  const drivers::TableLimits limits = table_limits(config);
  // 270 degrees is -90 to a table that ends at 180.
  const auto inside = [](double& angle_rad, const drivers::TableLimits::Range& range) {
    for (const double turns : {0.0, -1.0, 1.0}) {
      const double other = angle_rad + 2 * std::numbers::pi * turns;
      if (other < range.min_rad - kSlack_rad || other > range.max_rad + kSlack_rad) continue;
      angle_rad = other;
      return true;
    }
    return false;
  };
  std::erase_if(attitudes, [&](TableAngles& a) {
    return !inside(a.azimuth_rad, limits.azimuth) || !inside(a.pitch_rad, limits.pitch) ||
           !inside(a.roll_rad, limits.roll);
  });
  return attitudes;
}

}  // namespace mgtd::daemon::run
