// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/joined_runs.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/poses/pose_columns.h"
#include "calib/poses/run_time.h"

namespace mgtd::calib::poses {
namespace {

bool tells_time(const PoseTable& table) {
  return std::all_of(table.poses.begin(), table.poses.end(),
                     [](const Pose& p) { return missing_time(p).empty(); });
}

bool timeless(const PoseTable& table) {
  return std::none_of(table.poses.begin(), table.poses.end(),
                      [](const Pose& p) { return missing_time(p).empty(); });
}

/// First and last time in hours since `start`.
std::pair<double, double> span_h(const PoseTable& table, const RunTime& start) {
  const auto [first, last] =
      std::minmax_element(table.poses.begin(), table.poses.end(),
                          [&](const Pose& x, const Pose& y) { return start.hours(x) < start.hours(y); });
  return {start.hours(*first), start.hours(*last)};
}

/// `later` behind `earlier`, its times `shift_s` later.
PoseTable behind(PoseTable earlier, const PoseTable& later, double shift_s) {
  int last = 0;
  for (const Pose& pose : earlier.poses) last = std::max(last, pose.number);
  for (Pose pose : later.poses) {
    pose.number += last;
    if (pose.t_s) *pose.t_s += shift_s;
    earlier.poses.push_back(std::move(pose));
  }
  for (PathPoint point : later.path) {
    point.t_s += shift_s;
    earlier.path.push_back(point);
  }
  earlier.source += " and " + later.source;
  return earlier;
}

Error overlap(const PoseTable& a, const PoseTable& b) {
  return {ErrorCode::refused,
          fmt::format("{} and {} overlap in time: they are not two runs of one rig", a.source, b.source),
          "give two different runs; pose tables without t_utc must go on in t_s where the first ends"};
}

}  // namespace

Result<PoseTable> joined(const PoseTable& a, const PoseTable& b) {
  if (a.poses.empty() || b.poses.empty())
    return fail(ErrorCode::refused, fmt::format("{} has no poses", a.poses.empty() ? a.source : b.source),
                "leave it out");
  if (sensors_of(a) != sensors_of(b))
    return fail(ErrorCode::refused,
                fmt::format("{} has {} and {} has {}: this is another array", a.source,
                            counted(sensors_of(a)), b.source, counted(sensors_of(b))),
                "judge them one by one");
  if (timeless(a) && timeless(b)) return behind(a, b, 0);
  const RunTime of_a = RunTime::of(a), of_b = RunTime::of(b);
  if (!tells_time(a) || !tells_time(b) || of_a.start.has_value() != of_b.start.has_value())
    return fail(
        ErrorCode::refused,
        fmt::format("which of {} and {} came first is not told: t_utc, or t_s, is not in all poses of both",
                    a.source, b.source),
        "give both tables the column t_utc");
  const RunTime& origin = of_b.start < of_a.start ? of_b : of_a;
  const auto [first_a, last_a] = span_h(a, origin);
  const auto [first_b, last_b] = span_h(b, origin);
  if (first_b > last_a)
    return behind(a, b, of_a.start ? to_seconds(Duration{of_b.start->ns - of_a.start->ns}) : 0);
  if (of_a.start && first_a > last_b)
    return behind(b, a, to_seconds(Duration{of_a.start->ns - of_b.start->ns}));
  return tl::unexpected(overlap(a, b));
}

}  // namespace mgtd::calib::poses
