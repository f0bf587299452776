// SPDX-License-Identifier: Apache-2.0
#include "daemon/run_duration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mgtd::daemon {

double move_s(const Pace& pace, const TableAngles& from, const TableAngles& to) {
  const double most_rad =
      std::max({std::abs(to.azimuth_rad - from.azimuth_rad), std::abs(to.pitch_rad - from.pitch_rad),
                std::abs(to.roll_rad - from.roll_rad)});
  return pace.per_move_s + most_rad / pace.velocity_rad_per_s;
}

double pose_s(const Pace& pace, const RunPlan& plan, std::size_t index) {
  const TableAngles from = index == 0 ? TableAngles{} : plan.poses[index - 1].target;
  return move_s(pace, from, plan.poses[index].target) + pace.settle_s + plan.poses[index].dwell_s;
}

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
  std::string text = fmt::format(
      "{} poses: {} standard in {} deg steps, {} random ({} of them revisits, seed {}); dwells of {} and {} "
      "s; "
      "about {:.0f} min\n",
      plan.poses.size(), standard, plan.options.step_deg, random, revisits, plan.options.seed,
      plan.options.dwell_short_s, plan.options.dwell_long_s, std::ceil(minutes));
  for (const std::string& note : plan.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace mgtd::daemon
