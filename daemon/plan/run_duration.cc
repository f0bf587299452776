// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/run_duration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "daemon/plan/approach.h"

namespace mgtd::daemon::plan {

double move_s(const Pace& pace, const TableAngles& from, const TableAngles& to) {
  const double most_rad =
      std::max({std::abs(to.azimuth_rad - from.azimuth_rad), std::abs(to.pitch_rad - from.pitch_rad),
                std::abs(to.roll_rad - from.roll_rad)});
  return pace.per_move_s + most_rad / pace.velocity_rad_per_s;
}

double pose_s(const Pace& pace, const RunPlan& plan, std::size_t index) {
  const PlannedPose& pose = plan.poses[index];
  const int mounted = index == 0 ? 0 : plan.poses[index - 1].mount.value_or(0);
  const double hands_s =
      (plan.options.by_hand ? pace.by_hand_s : 0) + (pose.mount.value_or(0) != mounted ? pace.mount_s : 0);
  if (plan.options.by_hand) return hands_s + pace.settle_s + pose.dwell_s;
  const TableAngles from = index == 0 ? TableAngles{} : plan.poses[index - 1].target;
  const int natural = sense_of(from.azimuth_rad, pose.target.azimuth_rad);
  double way_s = move_s(pace, from, pose.target);
  if (pose.sense != 0 && pose.sense != natural) {
    TableAngles before = pose.target;
    before.azimuth_rad -= pose.sense * kApproach_rad;
    way_s = move_s(pace, from, before) + move_s(pace, before, pose.target);
  }
  const double rest_s =
      std::max(pace.settle_s + pose.dwell_s, pose.since_stop_s.value_or(0) + pose.dwell_s / 2);
  return hands_s + way_s + rest_s;
}

namespace {

RunPlan from_any_side(RunPlan plan) {
  for (PlannedPose& pose : plan.poses) pose.sense = 0;
  return plan;
}

}  // namespace

double total_s(const Pace& pace, const RunPlan& plan) {
  double sum_s = pace.home_s + pace.solve_s;
  for (std::size_t i = 0; i < plan.poses.size(); ++i) sum_s += pose_s(pace, plan, i);
  return sum_s;
}

std::string describe(const RunPlan& plan, const Pace& pace) {
  const auto count = [&](auto&& is) { return std::count_if(plan.poses.begin(), plan.poses.end(), is); };
  const auto standard = count([](const PlannedPose& p) { return p.set == "standard"; });
  const auto random = count([](const PlannedPose& p) { return p.set == "random"; });
  const auto revisits = count([](const PlannedPose& p) { return p.revisit_of.has_value(); });
  const double minutes = total_s(pace, plan) / 60;
  if (!plan.options.list.empty()) {
    return fmt::format("{} poses of {}, in its order; about {:.0f} min\n", plan.poses.size(),
                       plan.options.list, std::ceil(minutes));
  }
  std::string text = fmt::format(
      "{} poses: {} standard in {} deg steps, {} random ({} of them revisits, seed {}); dwells of {} and {} "
      "s; about {:.0f} min, {:.1f} of them so that the azimuth comes from both sides\n",
      plan.poses.size(), standard, plan.options.step_deg, random, revisits, plan.options.seed,
      plan.options.dwell_short_s, plan.options.dwell_long_s, std::ceil(minutes),
      minutes - total_s(pace, from_any_side(plan)) / 60);
  for (const std::string& note : plan.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace mgtd::daemon::plan
