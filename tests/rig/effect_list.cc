// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effect_list.h"

#include <fmt/format.h>

#include <cmath>

#include "tests/rig/effects/axis_hysteresis.h"
#include "tests/rig/effects/axis_law.h"
#include "tests/rig/effects/axis_settling.h"
#include "tests/rig/effects/site_dipole.h"
#include "tests/rig/effects/site_gradient.h"
#include "tests/rig/effects/table_law.h"

namespace mgtd::rig {
namespace {

double warm(const AxisContext& c) { return c.T_degC - kT0_degC; }
double hours(const AxisContext& c) { return c.t_s / 3600; }

/// y += coefficient * shape; t in hours from the start, T0 = 20 degC, x = v/F0.
constexpr std::array<AxisLaw, 11> kLaws{{
    {"axis.offset.temperature", "nT_per_degC", nullptr, [](const AxisContext& c, double) { return warm(c); }},
    {"axis.offset.temperature2", "nT_per_degC2", nullptr,
     [](const AxisContext& c, double) { return warm(c) * warm(c); }},
    {"axis.offset.drift", "nT_per_h", nullptr, [](const AxisContext& c, double) { return hours(c); }},
    {"axis.offset.step", "nT", "at_s",
     [](const AxisContext& c, double at_s) { return c.t_s < at_s ? 0. : 1.; }},
    {"axis.gain.temperature", "ppm_per_degC", nullptr,
     [](const AxisContext& c, double) { return 1e-6 * warm(c) * c.v(); }},
    {"axis.gain.temperature2", "ppm_per_degC2", nullptr,
     [](const AxisContext& c, double) { return 1e-6 * warm(c) * warm(c) * c.v(); }},
    {"axis.gain.drift", "ppm_per_h", nullptr,
     [](const AxisContext& c, double) { return 1e-6 * hours(c) * c.v(); }},
    {"axis.gain.step", "ppm", "above_nT",
     [](const AxisContext& c, double above) { return std::abs(c.v()) > above ? 1e-6 * c.v() : 0.; }},
    {"axis.quadratic", "nT_at_F0", nullptr, [](const AxisContext& c, double) { return c.x() * c.x(); }},
    {"axis.cubic", "nT_at_F0", nullptr, [](const AxisContext& c, double) { return c.x() * c.x() * c.x(); }},
    {"axis.zero-crossing", "nT", nullptr, [](const AxisContext& c, double) { return c.v() < 0 ? -1. : 1.; }},
}};

std::unique_ptr<Effect> axis_effect(Section& s, const AxisLaw& law) {
  const Where where = s.where();
  const double coefficient = s.needed(law.key);
  const double second = law.second_key == nullptr ? 0 : s.needed(law.second_key);
  return std::make_unique<AxisEffect>(law, where, coefficient, second);
}

struct Entry {
  const char* name;
  const char* keys;
  std::unique_ptr<Effect> (*make)(Section& s);
};

constexpr std::array<Entry, 8> kOthers{{
    {"axis.hysteresis", "where h_nT width",
     [](Section& s) -> std::unique_ptr<Effect> {
       double width = 0.1;
       s.read("width", width, {1e-6, 10});
       return std::make_unique<AxisHysteresis>(s.where(), s.needed("h_nT"), width);
     }},
    {"axis.settling", "where eta_nT tau_s",
     [](Section& s) -> std::unique_ptr<Effect> {
       double tau_s = 5;
       s.read("tau_s", tau_s, {1e-3, 1e6});
       return std::make_unique<AxisSettling>(s.where(), s.needed("eta_nT"), tau_s);
     }},
    {"site.gradient", "nT_per_m = [xx, yy, xy, xz, yz]",
     [](Section& s) -> std::unique_ptr<Effect> {
       return std::make_unique<SiteGradient>(s.needed_list<5>("nT_per_m"), SiteGradient::Five{});
     }},
    {"site.gradient-drift", "nT_per_m_per_h = [xx, yy, xy, xz, yz]",
     [](Section& s) -> std::unique_ptr<Effect> {
       return std::make_unique<SiteGradient>(SiteGradient::Five{}, s.needed_list<5>("nT_per_m_per_h"));
     }},
    {"site.dipole", "moment_Am2 = [x, y, z] at_m = [x, y, z]",
     [](Section& s) -> std::unique_ptr<Effect> {
       const auto moment_Am2 = s.needed_list<3>("moment_Am2");
       return std::make_unique<SiteDipole>(moment_Am2, s.needed_list<3>("at_m"));
     }},
    {"table.eccentricity", "cos_deg sin_deg",
     [](Section& s) -> std::unique_ptr<Effect> {
       const double cos_deg = s.needed("cos_deg");
       return std::make_unique<TableEccentricity>(cos_deg, s.needed("sin_deg"));
     }},
    {"table.angle-scale", "ppm",
     [](Section& s) -> std::unique_ptr<Effect> {
       return std::make_unique<TableAngleScale>(s.needed("ppm"));
     }},
    {"table.backlash", "deg",
     [](Section& s) -> std::unique_ptr<Effect> { return std::make_unique<TableBacklash>(s.needed("deg")); }},
}};

std::string names() {
  std::vector<std::string> out;
  for (const AxisLaw& law : kLaws) out.emplace_back(law.name);
  for (const Entry& entry : kOthers) out.emplace_back(entry.name);
  return fmt::format("{}", fmt::join(out, ", "));
}

}  // namespace

std::shared_ptr<const Effect> read_effect(Section& s) {
  std::string name;
  s.read("name", name);
  for (const AxisLaw& law : kLaws) {
    if (name == law.name) return axis_effect(s, law);
  }
  for (const Entry& entry : kOthers) {
    if (name == entry.name) return entry.make(s);
  }
  s.complain("name", fmt::format("no effect '{}'; there are: {}", name, names()));
  s.accept_rest();
  return nullptr;
}

std::vector<std::string> effect_help() {
  std::vector<std::string> out;
  for (const AxisLaw& law : kLaws) {
    out.push_back(fmt::format("{:26} where {}{}{}", law.name, law.key, law.second_key == nullptr ? "" : " ",
                              law.second_key == nullptr ? "" : law.second_key));
  }
  for (const Entry& entry : kOthers) out.push_back(fmt::format("{:26} {}", entry.name, entry.keys));
  return out;
}

}  // namespace mgtd::rig
