// SPDX-License-Identifier: Apache-2.0
#include "drivers/gcs2_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "drivers/baud.h"
#include "drivers/identity.h"
#include "proto/units.h"

namespace mgtd::drivers::gcs2 {
namespace {

constexpr std::array<std::pair<Turns, std::string_view>, 3> kTurns{
    {{Turns::azimuth, "azimuth"}, {Turns::pitch, "pitch"}, {Turns::roll, "roll"}}};

std::optional<TableLimits::Range> read_limits(Settings& s, std::string_view name, bool axis_exists) {
  const std::string key = fmt::format("limits.{}", name);
  const std::vector<double> deg = s.numbers(key, 2, {0, 0});
  if (!s.has(key)) return std::nullopt;
  if (!axis_exists) s.object(key, fmt::format("there is no axis axes.{}", name));
  if (deg[0] > deg[1]) s.object(key, "the lower limit comes first");
  return TableLimits::Range{to_rad(deg[0]), to_rad(deg[1])};
}

bool is_axis_name(std::string_view name) {
  return name.size() <= 8 && name.find_first_of(" =?\n\r\t") == std::string_view::npos;
}

}  // namespace

TableLimits::Range& travel(TableLimits& limits, Turns turns) {
  if (turns == Turns::azimuth) return limits.azimuth;
  return turns == Turns::pitch ? limits.pitch : limits.roll;
}

Gcs2Settings read_gcs2_settings(Settings& s) {
  Gcs2Settings out;
  out.baud = read_baud(s, kDefaultBaud);
  out.serial = read_serial(s);
  for (const auto& [turns, name] : kTurns) {
    const std::string key = fmt::format("axes.{}", name);
    AxisSettings axis{turns, std::string(name), s.text(key, turns == Turns::azimuth ? "1" : ""),
                      std::nullopt};
    axis.limits = read_limits(s, name, !axis.axis.empty());
    if (axis.axis.empty()) continue;
    if (!is_axis_name(axis.axis)) s.object(key, "must be the name of an axis in the controller, like \"1\"");
    const bool twice = std::any_of(out.axes.begin(), out.axes.end(),
                                   [&](const AxisSettings& other) { return other.axis == axis.axis; });
    if (twice) s.object(key, fmt::format("axis '{}' cannot turn two angles", axis.axis));
    out.axes.push_back(std::move(axis));
  }
  if (out.axes.empty()) s.object("axes.azimuth", "a table needs at least one axis");
  out.velocity_deg_per_s = s.number("velocity_deg_per_s", out.velocity_deg_per_s);
  if (!(out.velocity_deg_per_s > 0 && out.velocity_deg_per_s <= 1000))
    s.object("velocity_deg_per_s", "must be above 0 and at most 1000 deg/s");
  out.servo_off_in_dwell = s.boolean("servo_off_in_dwell", true);
  out.dwell_tolerance_deg = s.number("dwell_tolerance_deg", out.dwell_tolerance_deg);
  if (!(out.dwell_tolerance_deg > 0)) s.object("dwell_tolerance_deg", "must be above 0 deg");
  return out;
}

}  // namespace mgtd::drivers::gcs2
