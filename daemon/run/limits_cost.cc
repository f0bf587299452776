// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/limits_cost.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "calib/calibration/tensor.h"
#include "calib/sensor/sensor_model.h"
#include "daemon/run/planned_poses.h"
#include "proto/units.h"

namespace mgtd::daemon::run {
namespace {

using drivers::TableLimits;
using Range = TableLimits::Range;

constexpr double kPi = std::numbers::pi;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kLeast_rad = to_rad(1);  ///< less travel is no axis; less left out is no limit
constexpr double kWorth = 0.05;           ///< a standard error that grows by less is not worth a word
constexpr std::array kMore{1.25, 1.5, 2.0, 3.0, 4.0};

struct NamedAxis {
  const char* name;
  Range TableLimits::*range;
  Range whole;
};
constexpr std::array<NamedAxis, 3> kTableAxes{{{"azimuth", &TableLimits::azimuth, {-kPi, kPi}},
                                               {"pitch", &TableLimits::pitch, {-kPi / 2, kPi / 2}},
                                               {"roll", &TableLimits::roll, {-kPi, kPi}}}};

double width(const Range& range) { return range.max_rad - range.min_rad; }

bool narrows(const Range& range, const Range& whole) {
  return width(range) > kLeast_rad && width(range) < width(whole) - kLeast_rad;
}

/// Beyond a quarter turn of pitch the attitudes come again, at other azimuths and rolls.
double upright(double pitch_rad) { return std::sin(std::clamp(pitch_rad, -kPi / 2, kPi / 2)); }

TableLimits without_limits(TableLimits limits) {
  for (const NamedAxis& axis : kTableAxes)
    if (narrows(limits.*axis.range, axis.whole)) limits.*axis.range = axis.whole;
  return limits;
}

/// Of one kind: parameters `first` .. `first + 2` of each sensor.
struct Kind {
  const char* name;
  std::size_t first;
};
constexpr std::array<Kind, 4> kKinds{
    {{"angles between the axes", 0}, {"scale factors", 3}, {"offsets", 6}, {"angles to the platform", 9}}};

LimitsCost::Group tensor_group(const calib::design::DesignReport& within,
                               const calib::design::DesignReport& without) {
  static constexpr std::array<std::pair<const char*, double Gradient::*>, 6> kComponents{
      {{"xx", &Gradient::xx},
       {"yy", &Gradient::yy},
       {"zz", &Gradient::zz},
       {"xy", &Gradient::xy},
       {"xz", &Gradient::xz},
       {"yz", &Gradient::yz}}};
  LimitsCost::Group out{.name = "tensor", .unit = "nT/m", .worst = {}};
  out.without = calib::calibration::root_mean_square(without.tensor_sd_nT_per_m);
  out.within =
      within.determined ? calib::calibration::root_mean_square(within.tensor_sd_nT_per_m) : kInfinite;
  for (const auto& [name, component] : kComponents) {
    if (!within.determined) break;
    const double times = within.tensor_sd_nT_per_m.*component / without.tensor_sd_nT_per_m.*component;
    if (times > out.worst_times) out.worst_times = times, out.worst = name;
  }
  return out;
}

LimitsCost::Group parameter_group(const Kind& kind, const calib::design::DesignReport& within,
                                  const calib::design::DesignReport& without) {
  LimitsCost::Group out{.name = kind.name, .unit = without.parameters[kind.first].unit, .worst = {}};
  double inside = 0, outside = 0, count = 0;
  for (std::size_t slot = 0; slot < without.sensors; ++slot) {
    for (std::size_t k = kind.first; k < kind.first + 3; ++k, ++count) {
      const std::size_t at = slot * calib::sensor::kSensorParameters + k;
      const double free = without.parameters[at].sd;
      outside += free * free;
      if (!within.determined) continue;
      const double sd = within.parameters[at].sd;
      inside += sd * sd;
      if (sd / free > out.worst_times) out.worst_times = sd / free, out.worst = within.parameters[at].name;
    }
  }
  out.without = std::sqrt(outside / count);
  out.within = within.determined ? std::sqrt(inside / count) : kInfinite;
  return out;
}

/// The tensor, where the array tells any of it, then the parameters of each kind.
std::vector<LimitsCost::Group> groups_of(const calib::design::DesignReport& within,
                                         const calib::design::DesignReport& without) {
  std::vector<LimitsCost::Group> out;
  if (std::isfinite(calib::calibration::root_mean_square(without.tensor_sd_nT_per_m)))
    out.push_back(tensor_group(within, without));
  for (const Kind& kind : kKinds) out.push_back(parameter_group(kind, within, without));
  return out;
}

/// Scale factors in parts per million.
std::string amount(double sd, const std::string& unit) {
  if (!std::isfinite(sd)) return "unknown";
  return unit.empty() ? fmt::format("{:.3g} ppm", 1e6 * sd) : fmt::format("{:.3g} {}", sd, unit);
}

Result<calib::design::DesignReport> expected(const plan::PlanOptions& options, const TableLimits& limits,
                                             calib::design::DesignRequest request) {
  auto poses = planned_poses(options, limits);
  if (!poses) return tl::unexpected(poses.error());
  request.poses = std::move(*poses);
  request.power = false;
  request.candidates.clear();
  return calib::design::evaluate_design(request);
}

std::string axes_text(const LimitsCost& cost) {
  std::vector<std::string> axes;
  for (const LimitsCost::Axis& axis : cost.axes)
    axes.push_back(fmt::format("{} {:.4g} to {:.4g} deg", axis.name, axis.min_deg, axis.max_deg));
  return fmt::format("{}", fmt::join(axes, ", "));
}

std::string remedy(const LimitsCost& cost) {
  std::vector<std::string> keys;
  for (const LimitsCost::Axis& axis : cost.axes) keys.push_back("limits." + axis.name);
  std::string out =
      fmt::format("widen {} in [table] as far as cables and the table allow", fmt::join(keys, " and "));
  if (cost.random_enough)
    out += fmt::format("; or measure more: random = {} in [run] instead of {} makes up for the limits",
                       *cost.random_enough, cost.random);
  else if (cost.random > 0)
    out += fmt::format("; four times the {} random poses would not make up for the limits", cost.random);
  return out;
}

bool matters(const LimitsCost& cost) {
  return std::any_of(cost.groups.begin(), cost.groups.end(), [](const LimitsCost::Group& group) {
    return !std::isfinite(group.within) || group.times() > 1 + kWorth;
  });
}

}  // namespace

double attitudes_left_out(const TableLimits& limits) {
  double kept = 1;
  for (const NamedAxis& axis : kTableAxes) {
    const Range& range = limits.*axis.range;
    if (!narrows(range, axis.whole)) continue;
    kept *= axis.range == &TableLimits::pitch ? (upright(range.max_rad) - upright(range.min_rad)) / 2
                                              : width(range) / width(axis.whole);
  }
  return 1 - kept;
}

Result<std::optional<LimitsCost>> limits_cost(const plan::PlanOptions& options, const TableLimits& limits,
                                              calib::design::DesignRequest request) {
  LimitsCost out;
  for (const NamedAxis& axis : kTableAxes) {
    const Range& range = limits.*axis.range;
    if (narrows(range, axis.whole))
      out.axes.push_back({axis.name, to_deg(range.min_rad), to_deg(range.max_rad)});
  }
  if (out.axes.empty()) return std::optional<LimitsCost>();
  out.left_out = attitudes_left_out(limits);
  out.random = options.random;
  const auto within = expected(options, limits, request);
  if (!within) return tl::unexpected(within.error());
  const auto without = expected(options, without_limits(limits), request);
  if (!without) return tl::unexpected(without.error());
  if (!without->determined) return std::optional<LimitsCost>();  // it is not the limits
  out.groups = groups_of(*within, *without);
  for (const double times : kMore) {
    plan::PlanOptions more = options;
    more.random = static_cast<int>(std::lround(times * options.random));
    const auto longer = expected(more, limits, request);
    if (!longer || !longer->determined) continue;
    const std::vector<LimitsCost::Group> groups = groups_of(*longer, *without);
    if (std::any_of(groups.begin(), groups.end(), [](const auto& group) { return group.times() > 1; }))
      continue;
    out.random_enough = more.random;
    break;
  }
  return std::optional(std::move(out));
}

nlohmann::json to_json(const LimitsCost& cost) {
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
  };
  nlohmann::json axes = nlohmann::json::array(), groups = nlohmann::json::array();
  for (const LimitsCost::Axis& axis : cost.axes)
    axes.push_back({{"axis", axis.name}, {"min_deg", axis.min_deg}, {"max_deg", axis.max_deg}});
  for (const LimitsCost::Group& group : cost.groups)
    groups.push_back({{"name", group.name},
                      {"unit", group.unit},
                      {"sd_within", number(group.within)},
                      {"sd_without", number(group.without)},
                      {"times", number(group.times())},
                      {"worst", group.worst.empty() ? nlohmann::json() : nlohmann::json(group.worst)},
                      {"worst_times", number(group.worst_times)}});
  return {{"axes", std::move(axes)},
          {"left_out_share", cost.left_out},
          {"groups", std::move(groups)},
          {"random_enough", cost.random_enough ? nlohmann::json(*cost.random_enough) : nlohmann::json()},
          {"remedy", matters(cost) ? remedy(cost) : ""}};
}

std::string to_text(const LimitsCost& cost) {
  std::string out = fmt::format("limits of the table: {}; {:.0f} % of all attitudes are left out\n",
                                axes_text(cost), 100 * cost.left_out);
  if (!matters(cost)) return out + "  no standard error grows by more than 5 %: nothing to do\n";
  out += fmt::format("  {:<26}{:>16}{:>16}{:>8}   {}\n", "standard error (rms)", "within them", "without",
                     "times", "most");
  for (const LimitsCost::Group& group : cost.groups) {
    out += fmt::format("  {:<26}{:>16}{:>16}", group.name, amount(group.within, group.unit),
                       amount(group.without, group.unit));
    if (std::isfinite(group.within)) out += fmt::format("{:>8.2f}", group.times());
    if (!group.worst.empty()) out += fmt::format("   {} {:.2f} times", group.worst, group.worst_times);
    out += "\n";
  }
  return out + "  what to do: " + remedy(cost) + "\n";
}

}  // namespace mgtd::daemon::run
