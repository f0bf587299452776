// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/plan_from_list.h"

#include <fmt/format.h>

#include <map>
#include <numbers>

#include "proto/units.h"

namespace mgtd::daemon::plan {
namespace {

using Range = drivers::TableLimits::Range;

std::string place(const RunRequest& request, const RequestedPose& pose) {
  const std::string file = request.list.empty() ? "the list" : request.list;
  return pose.line > 0 ? fmt::format("{}:{}", file, pose.line)
                       : fmt::format("{}, pose {}", file, pose.number);
}

/// 270 degrees is -90 to a table that ends at 180.
Result<double> within(double a_rad, const Range& range, const char* column, const std::string& where) {
  constexpr double kSlack_rad = 1e-6;
  for (const double turns : {0.0, -1.0, 1.0, -2.0, 2.0}) {
    const double other = a_rad + 2 * std::numbers::pi * turns;
    if (other >= range.min_rad - kSlack_rad && other <= range.max_rad + kSlack_rad) return other;
  }
  return fail(ErrorCode::bad_input,
              fmt::format("{}: column {}: {:.6g} deg is outside the table's limits, {:.6g} to {:.6g} deg",
                          where, column, to_deg(a_rad), to_deg(range.min_rad), to_deg(range.max_rad)),
              "take the pose out, or widen the limits in the configuration where the table allows it");
}

Result<PlannedPose> planned(const RunRequest& request, const RequestedPose& wish, const PlanOptions& options,
                            const drivers::TableLimits& limits) {
  const std::string where = place(request, wish);
  const auto azimuth = within(wish.angles.azimuth_rad, limits.azimuth, "azimuth_deg", where);
  if (!azimuth) return tl::unexpected(azimuth.error());
  const auto pitch = within(wish.angles.pitch_rad, limits.pitch, "pitch_deg", where);
  if (!pitch) return tl::unexpected(pitch.error());
  const auto roll = within(wish.angles.roll_rad, limits.roll, "roll_deg", where);
  if (!roll) return tl::unexpected(roll.error());
  PlannedPose pose;
  pose.number = wish.number;
  pose.set = wish.set.empty() ? "random" : wish.set;
  pose.target = {*azimuth, *pitch, *roll};
  pose.dwell_s = wish.dwell_s.value_or(options.dwell_short_s);
  pose.sense = options.by_hand ? 0 : wish.sense.value_or(0);
  pose.since_stop_s = wish.since_stop_s;
  pose.note = wish.note;
  return pose;
}

}  // namespace

std::vector<RequestedPose> requested_poses(const calib::poses::PoseList& list) {
  std::vector<RequestedPose> out;
  for (std::size_t i = 0; i < list.table.poses.size(); ++i) {
    const Pose& p = list.table.poses[i];
    out.push_back({.number = p.number,
                   .angles = p.angles().value_or(TableAngles{}),
                   .set = p.set,
                   .sense = p.sense,
                   .dwell_s = p.dwell_s,
                   .since_stop_s = p.since_stop_s,
                   .note = i < list.notes.size() ? list.notes[i] : std::string(),
                   .line = list.lines[i]});
  }
  return out;
}

Result<RunPlan> plan_from_list(const RunRequest& request, const PlanOptions& options,
                               const drivers::TableLimits& limits) {
  if (!options.mounts.empty())
    return fail(ErrorCode::refused,
                "a list of poses does not say how the array is mounted on the table by hand",
                "run a list on a table of two or three axes, or one turned by hand (driver = \"hand\")");
  RunPlan plan;
  plan.options = options;
  plan.options.step_deg = 0;
  plan.options.random = plan.options.revisits = 0;
  plan.options.list = request.list.empty() ? "a list" : request.list;
  std::map<int, std::string> places;
  for (const RequestedPose& wish : request.poses) {
    auto pose = planned(request, wish, options, limits);
    if (!pose) return tl::unexpected(pose.error());
    const auto [first, fresh] = places.emplace(wish.number, place(request, wish));
    if (!fresh)
      return fail(ErrorCode::bad_input,
                  fmt::format("{}: column pose: {} was already given at {}", place(request, wish),
                              wish.number, first->second),
                  "give every pose a number of its own; equal angles may repeat");
    plan.poses.push_back(*std::move(pose));
  }
  return plan;
}

}  // namespace mgtd::daemon::plan
