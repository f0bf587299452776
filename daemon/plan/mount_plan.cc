// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/mount_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "daemon/plan/approach.h"
#include "daemon/plan/random_source.h"
#include "proto/number.h"
#include "proto/units.h"

namespace mgtd::daemon::plan {
namespace {

/// Evenly over at most one turn of the travel, in random order.
std::vector<double> azimuths_rad(RandomSource& random, const drivers::TableLimits::Range& range, int count) {
  const double span_deg = std::min(360.0, to_deg(range.max_rad - range.min_rad));
  const double from_deg = to_deg(range.min_rad + range.max_rad) / 2 - span_deg / 2;
  const double shift = random.uniform(0, 1);
  std::vector<double> out;
  for (int k = 0; k < count; ++k) {
    const double a_deg = std::round((from_deg + span_deg * (k + shift) / count) * kPerDegree) / kPerDegree;
    out.push_back(std::clamp(to_rad(a_deg), range.min_rad, range.max_rad));
  }
  random.shuffle(out);
  return out;
}

void add_block(RunPlan& plan, RandomSource& random, const drivers::TableLimits& limits, int mount, int poses,
               int revisits) {
  const PlanOptions& o = plan.options;
  const TableAngles mounting = o.mounts[static_cast<std::size_t>(mount - 1) % o.mounts.size()];
  const std::size_t first = plan.poses.size();
  const auto add = [&](double azimuth_rad, std::optional<int> revisit_of) {
    PlannedPose pose;
    pose.number = static_cast<int>(plan.poses.size()) + 1;
    pose.set = "random";
    pose.target.azimuth_rad = azimuth_rad;
    pose.dwell_s = random.below(2) == 0 ? o.dwell_short_s : o.dwell_long_s;
    pose.sense = possible_sense(random.below(2) == 0 ? +1 : -1, pose.target, limits);
    pose.mount = mount;
    pose.mounting = mounting;
    pose.revisit_of = revisit_of;
    plan.poses.push_back(std::move(pose));
  };
  for (const double azimuth_rad : azimuths_rad(random, limits.azimuth, poses - revisits))
    add(azimuth_rad, {});
  for (int k = 0; k < revisits; ++k) {  // the earliest of the block, long ago by now
    const PlannedPose& earlier = plan.poses[first + static_cast<std::size_t>(k)];
    add(earlier.target.azimuth_rad, earlier.number);
  }
}

/// Share `k` of `n` of a total, in whole numbers.
int share(int total, int k, int n) { return total * (k + 1) / n - total * k / n; }

}  // namespace

std::vector<TableAngles> usual_mounts() {
  const double side = to_rad(90);
  return {{0, 0, 0}, {0, 0, side}, {0, side, 0}, {0, 0, -side}, {0, -side, 0}};
}

void add_mounts(RunPlan& plan, const drivers::TableLimits& limits) {
  const PlanOptions& o = plan.options;
  for (PlannedPose& pose : plan.poses) {
    pose.mount = 1;
    pose.mounting = o.mounts.front();
  }
  const int blocks = static_cast<int>(o.mounts.size()) + (o.mounts.size() > 1 ? 1 : 0);
  RandomSource random(o.seed);
  for (int b = 0; b < blocks; ++b) {
    const int poses = share(o.random, b, blocks);
    add_block(plan, random, limits, b + 1, poses, std::min(share(o.revisits, b, blocks), poses / 2));
  }
}

void note_mounts(RunPlan& plan) {
  std::set<int> numbers;
  for (const PlannedPose& pose : plan.poses)
    if (pose.mount) numbers.insert(*pose.mount);
  std::string words;
  for (const TableAngles& mount : plan.options.mounts)
    words += (words.empty() ? "" : ", ") + mounting_in_words(mount);
  plan.notes.push_back(
      fmt::format("the operator is asked {} times to mount the array: {}, and the first once more",
                  numbers.size(), words));
}

std::string mounting_in_words(const TableAngles& m) {
  std::string out;
  const auto add = [&](const char* axis, double a_rad) {
    if (a_rad != 0) out += fmt::format("{}{} {:.6g} deg", out.empty() ? "" : ", ", axis, to_deg(a_rad));
  };
  add("azimuth", m.azimuth_rad);
  add("pitch", m.pitch_rad);
  add("roll", m.roll_rad);
  return out.empty() ? "level" : out;
}

Result<TableAngles> parse_mounting(const std::string& text) {
  const auto refuse = [&] {
    return fail(ErrorCode::bad_input, fmt::format("'{}' is not a mounting of the array", text),
                "say \"level\", \"roll 90\" or \"pitch -90\", in degrees");
  };
  TableAngles out;
  std::istringstream in(text);
  std::string axis, value;
  if (text == "level") return out;
  bool any = false;
  while (in >> axis) {
    const auto degrees = in >> value ? parse_number(value) : std::nullopt;
    if (!degrees || !(std::abs(*degrees) <= 360)) return refuse();
    double* const angle = axis == "azimuth" ? &out.azimuth_rad
                          : axis == "pitch" ? &out.pitch_rad
                          : axis == "roll"  ? &out.roll_rad
                                            : nullptr;
    if (angle == nullptr) return refuse();
    *angle = to_rad(*degrees);
    any = true;
  }
  if (!any) return refuse();
  return out;
}

}  // namespace mgtd::daemon::plan
