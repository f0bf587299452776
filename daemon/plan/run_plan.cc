// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/run_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "daemon/plan/approach.h"
#include "daemon/plan/mount_plan.h"
#include "daemon/plan/random_source.h"
#include "proto/units.h"

namespace mgtd::daemon::plan {
namespace {

using drivers::TableLimits;

constexpr int kMinRandom = 9;                 ///< unknowns of a sensor by itself
constexpr double kMinTravel_rad = to_rad(1);  ///< less is no axis

/// Multiples of 0.01 deg inside a range of travel.
struct Travel {
  double min_deg{0}, max_deg{0};

  explicit Travel(const TableLimits::Range& range)
      : min_deg(std::ceil(to_deg(range.min_rad) * kPerDegree - 1e-6) / kPerDegree),
        max_deg(std::floor(to_deg(range.max_rad) * kPerDegree + 1e-6) / kPerDegree) {}
  [[nodiscard]] double clamp(double a_deg) const {
    return std::clamp(std::round(a_deg * kPerDegree) / kPerDegree, min_deg, std::max(min_deg, max_deg));
  }
  [[nodiscard]] double width_deg() const { return max_deg - min_deg; }
  [[nodiscard]] double centre_deg() const { return (min_deg + max_deg) / 2; }
};

bool exists(const TableLimits::Range& range) { return range.max_rad - range.min_rad > kMinTravel_rad; }

/// At most one turn of it, about the middle of its travel: further turns bring no new attitude.
TableLimits::Range one_turn(const TableLimits::Range& range) {
  const double half_rad = std::min((range.max_rad - range.min_rad) / 2, std::numbers::pi);
  const double centre_rad = (range.min_rad + range.max_rad) / 2;
  return {centre_rad - half_rad, centre_rad + half_rad};
}

/// Integral of |cos x| from -pi/2 to a.
double pitch_measure(double a) {
  const double lobe = std::floor(a / std::numbers::pi + 0.5);
  return 2 * lobe + 1 + std::sin(a - lobe * std::numbers::pi);
}
double pitch_of_measure(double m) {
  const double lobe = std::floor(m / 2);
  return lobe * std::numbers::pi + std::asin(std::clamp(m - 2 * lobe - 1, -1.0, 1.0));
}

TableAngles angles(double azimuth_deg, double pitch_deg, double roll_deg) {
  return {to_rad(azimuth_deg), to_rad(pitch_deg), to_rad(roll_deg)};
}

TableAngles random_attitude(RandomSource& random, const TableLimits& limits) {
  const auto azimuth = one_turn(limits.azimuth), roll = one_turn(limits.roll);
  const double low = pitch_measure(limits.pitch.min_rad), high = pitch_measure(limits.pitch.max_rad);
  const double az_rad = random.uniform(azimuth.min_rad, azimuth.max_rad);
  const double pitch_rad = pitch_of_measure(random.uniform(low, high));
  const double roll_rad = random.uniform(roll.min_rad, roll.max_rad);
  return angles(Travel(limits.azimuth).clamp(to_deg(az_rad)), Travel(limits.pitch).clamp(to_deg(pitch_rad)),
                Travel(limits.roll).clamp(to_deg(roll_rad)));
}

/// Where the turn starts: a multiple of the step if the travel allows, half a turn before its middle.
double first_azimuth_deg(const Travel& travel, double step_deg, double turn_deg) {
  const double wanted = std::max(travel.min_deg, travel.centre_deg() - 180);
  const double on_grid = std::ceil(wanted / step_deg - 1e-6) * step_deg;
  return on_grid + turn_deg <= travel.max_deg + 1e-9 ? on_grid : wanted;
}

void add_standard(RunPlan& plan, const TableLimits& limits) {
  const double step_deg = plan.options.step_deg;
  const Travel travel(limits.azimuth);
  const int whole = static_cast<int>(std::lround(360 / step_deg));
  const int fits = static_cast<int>(std::floor(travel.width_deg() / step_deg + 1e-6)) + 1;
  const int count = std::min(whole, fits);
  const double start_deg = first_azimuth_deg(travel, step_deg, step_deg * (count - 1));
  const auto add = [&](int k, int sense) {
    const TableAngles target = angles(travel.clamp(start_deg + k * step_deg), Travel(limits.pitch).clamp(0),
                                      Travel(limits.roll).clamp(0));
    plan.poses.push_back({static_cast<int>(plan.poses.size()) + 1, "standard", target,
                          plan.options.dwell_short_s, sense, std::nullopt});
  };
  for (int k = 0; k < count; k += 2) add(k, +1);
  for (int k = count - 1 - count % 2; k > 0; k -= 2) add(k, -1);
  if (count < whole) {
    plan.notes.push_back(
        fmt::format("the azimuth reaches {:.4g} to {:.4g} deg, not a whole turn: {} of {} standard poses",
                    travel.min_deg, travel.max_deg, count, whole));
  }
}

/// Takes one out of the attitudes visited once, never the one the table stands at.
std::optional<std::size_t> take_earlier(RandomSource& random, std::vector<std::size_t>& once,
                                        std::size_t poses) {
  const bool stands_there = !once.empty() && once.back() + 1 == poses;
  const std::size_t choice = once.size() - (stands_there ? 1 : 0);
  if (choice == 0) return std::nullopt;
  const std::size_t at = random.below(choice);
  const std::size_t earlier = once[at];
  once.erase(once.begin() + static_cast<std::ptrdiff_t>(at));
  return earlier;
}

/// Which places of the random set are revisits; the first two never are.
std::vector<bool> revisit_places(RandomSource& random, int poses, int revisits) {
  std::vector<bool> taken(static_cast<std::size_t>(poses), false);
  std::vector<std::size_t> places;
  for (std::size_t i = 2; i < taken.size(); ++i) places.push_back(i);
  random.shuffle(places);
  for (int i = 0; i < revisits; ++i) taken[places[static_cast<std::size_t>(i)]] = true;
  return taken;
}

void add_random(RunPlan& plan, const TableLimits& limits) {
  RandomSource random(plan.options.seed);
  std::vector<std::size_t> once;  // indices of attitudes visited once
  const auto is_revisit = revisit_places(random, plan.options.random, plan.options.revisits);
  int owed = 0;  // revisits for which no earlier attitude was left
  for (const bool here : is_revisit) {
    PlannedPose pose;
    pose.number = static_cast<int>(plan.poses.size()) + 1;
    pose.set = "random";
    owed += here ? 1 : 0;
    const auto earlier = owed > 0 ? take_earlier(random, once, plan.poses.size()) : std::nullopt;
    if (earlier) {
      --owed;
      pose.target = plan.poses[*earlier].target;
      pose.revisit_of = plan.poses[*earlier].number;
    } else {
      pose.target = random_attitude(random, limits);
      once.push_back(plan.poses.size());
    }
    pose.dwell_s = random.below(2) == 0 ? plan.options.dwell_short_s : plan.options.dwell_long_s;
    pose.sense = possible_sense(random.below(2) == 0 ? +1 : -1, pose.target, limits);
    plan.poses.push_back(std::move(pose));
  }
}

Result<void> sensible(const PlanOptions& o) {
  const auto refuse = [](std::string message, std::string remedy) {
    return fail(ErrorCode::usage, std::move(message), std::move(remedy));
  };
  if (o.step_deg != 0) {
    const double count = 360 / o.step_deg;
    const bool whole = o.step_deg > 0 && std::abs(count - std::round(count)) < 1e-9;
    if (!whole || count < 8 || count > 3600 || std::lround(count) % 2 != 0)
      return refuse(
          fmt::format("a step of {} deg does not divide a turn into an even number of 8 to 3600 poses",
                      o.step_deg),
          "use 10 or 20 deg");
  }
  if (o.random < 0 || o.random > 100'000 || (o.random == 0 && o.step_deg == 0))
    return refuse(fmt::format("{} random poses", o.random),
                  "use 0 to 100000, and 0 only with a standard set");
  if (o.revisits < 0 || (o.revisits > 0 && o.revisits > (o.random - 2) / 2))
    return refuse(fmt::format("{} revisits among {} random poses", o.revisits, o.random),
                  "use at most half of the random poses less one");
  if (!(o.dwell_short_s >= 0.5) || !(o.dwell_long_s >= o.dwell_short_s) || o.dwell_long_s > 3600)
    return refuse(fmt::format("dwells of {} and {} s", o.dwell_short_s, o.dwell_long_s),
                  "use 0.5 to 3600 s, the long one not below the short one");
  return {};
}

void note_sets(RunPlan& plan) {
  if (plan.options.step_deg == 0)
    plan.notes.emplace_back(
        "there is no standard set: the two-step calibration needs one and will be refused");
  if (plan.options.random < kMinRandom)
    plan.notes.push_back(
        fmt::format("{} random poses: a calibration needs at least {} attitudes off the vertical",
                    plan.options.random, kMinRandom));
}

void note_axes(RunPlan& plan, const TableLimits& limits) {
  const bool pitch = exists(limits.pitch), roll = exists(limits.roll);
  if (!plan.options.mounts.empty()) {
    note_mounts(plan);
  } else if (!pitch && !roll) {
    plan.notes.emplace_back(
        "the table turns about one axis only: a calibration needs attitudes about at least two, and one "
        "fitted "
        "to this run will be refused; let it be mounted by hand in other ways (mounts in [table]), or add a "
        "pitch or roll axis");
  } else if (!pitch || !roll) {
    plan.notes.push_back(fmt::format("the table has no {} axis: attitudes are uniform over the two it has",
                                     pitch ? "roll" : "pitch"));
  }
  const auto narrow = [&](const char* axis, const TableLimits::Range& range, double wanted_rad) {
    if (!exists(range) || range.max_rad - range.min_rad > wanted_rad - kMinTravel_rad) return;
    plan.notes.push_back(fmt::format("the {} reaches only {:.4g} to {:.4g} deg", axis, to_deg(range.min_rad),
                                     to_deg(range.max_rad)));
  };
  narrow("pitch", limits.pitch, std::numbers::pi);
  narrow("roll", limits.roll, 2 * std::numbers::pi);
}

/// A scale that is set by hand: whole steps, and no matter from which side.
void make_readable(RunPlan& plan, const TableLimits& limits) {
  constexpr double kStep_deg = 5;
  const auto readable = [&](double a_rad, const TableLimits::Range& range) {
    const double a_deg = std::round(to_deg(a_rad) / kStep_deg) * kStep_deg;
    const Travel travel(range);
    return to_rad(a_deg > travel.max_deg   ? a_deg - kStep_deg
                  : a_deg < travel.min_deg ? a_deg + kStep_deg
                                           : a_deg);
  };
  for (PlannedPose& pose : plan.poses) {
    pose.sense = 0;
    if (pose.set == "standard") continue;
    pose.target = {readable(pose.target.azimuth_rad, limits.azimuth),
                   readable(pose.target.pitch_rad, limits.pitch),
                   readable(pose.target.roll_rad, limits.roll)};
  }
}

}  // namespace

Result<RunPlan> make_plan(const PlanOptions& options, const TableLimits& limits) {
  if (auto ok = sensible(options); !ok) return tl::unexpected(ok.error());
  if (!exists(limits.azimuth))
    return fail(ErrorCode::refused, "the table has no azimuth axis", "configure axes.azimuth and its limits");
  RunPlan plan;
  plan.options = options;
  if (options.step_deg > 0) add_standard(plan, limits);
  if (options.random > 0 && options.mounts.empty()) add_random(plan, limits);
  if (!options.mounts.empty()) add_mounts(plan, limits);
  if (options.by_hand) make_readable(plan, limits);
  note_sets(plan);
  note_axes(plan, limits);
  return plan;
}

}  // namespace mgtd::daemon::plan
