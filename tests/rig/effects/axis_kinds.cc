// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "tests/rig/effect_kind.h"
#include "tests/rig/effects/axis_hysteresis.h"
#include "tests/rig/effects/axis_settling.h"
#include "tests/rig/rotations.h"

/// Effects of one axis: what is added to its reading. T0 = 20 degC, t in hours from the start, x = v/F0.
namespace mgtd::rig {
namespace {

double warm(const AxisContext& c) { return c.T_degC - kT0_degC; }
double hours(const AxisContext& c) { return c.t_s / 3600; }
/// What an axis sees when it leans towards the two others, in the order x, y, z, by so many arc seconds.
double leaning_nT(const AxisContext& c, const Numbers& n) {
  return kDeg / 3600 * kF0_nT * (n[0] * c.other(0) + n[1] * c.other(1));
}

constexpr std::array kAxisKinds{
    EffectKind{.name = "axis.offset.temperature",
               .scope = Scope::axis,
               .keys = {{{"nT_per_degC", 1, 2}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return n[0] * warm(c); }},
    EffectKind{.name = "axis.offset.temperature2",
               .scope = Scope::axis,
               .keys = {{{"nT_per_degC2", 1, 0.1}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return n[0] * warm(c) * warm(c); }},
    EffectKind{.name = "axis.offset.drift",
               .scope = Scope::axis,
               .keys = {{{"nT_per_h", 1, 5}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return n[0] * hours(c); }},
    EffectKind{.name = "axis.offset.step",
               .scope = Scope::axis,
               .keys = {{{"nT", 1, 3}, {"at_s", 1, 0, 400, 1600}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return c.t_s < n[1] ? 0 : n[0]; }},
    EffectKind{.name = "axis.gain.temperature",
               .scope = Scope::axis,
               .keys = {{{"ppm_per_degC", 1, 60}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return 1e-6 * n[0] * warm(c) * c.v(); }},
    EffectKind{.name = "axis.gain.temperature2",
               .scope = Scope::axis,
               .keys = {{{"ppm_per_degC2", 1, 3}}},
               .axis = [](const AxisContext& c,
                          const Numbers& n) { return 1e-6 * n[0] * warm(c) * warm(c) * c.v(); }},
    EffectKind{.name = "axis.gain.drift",
               .scope = Scope::axis,
               .keys = {{{"ppm_per_h", 1, 40}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return 1e-6 * n[0] * hours(c) * c.v(); }},
    EffectKind{.name = "axis.gain.step",
               .scope = Scope::axis,
               .keys = {{{"ppm", 1, 100}, {"above_nT", 1, 0, 15'000, 35'000}}},
               .axis = [](const AxisContext& c,
                          const Numbers& n) { return std::abs(c.v()) > n[1] ? 1e-6 * n[0] * c.v() : 0; }},
    EffectKind{.name = "axis.orthogonality.temperature",
               .scope = Scope::axis,
               .keys = {{{"arcsec_per_degC", 2, 10}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return warm(c) * leaning_nT(c, n); }},
    EffectKind{
        .name = "axis.orthogonality.temperature2",
        .scope = Scope::axis,
        .keys = {{{"arcsec_per_degC2", 2, 2}}},
        .axis = [](const AxisContext& c, const Numbers& n) { return warm(c) * warm(c) * leaning_nT(c, n); }},
    EffectKind{.name = "axis.quadratic",
               .scope = Scope::axis,
               .keys = {{{"nT_at_F0", 1, 8}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return n[0] * c.x() * c.x(); }},
    EffectKind{.name = "axis.cubic",
               .scope = Scope::axis,
               .keys = {{{"nT_at_F0", 1, 10}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return n[0] * c.x() * c.x() * c.x(); }},
    // tau1 (x_b^2 + x_c^2) + tau2 x_b x_c
    EffectKind{.name = "axis.transverse",
               .scope = Scope::axis,
               .keys = {{{"nT_at_F0", 2, 8}}},
               .axis =
                   [](const AxisContext& c, const Numbers& n) {
                     const double b = c.other(0), d = c.other(1);
                     return n[0] * (b * b + d * d) + n[1] * b * d;
                   }},
    EffectKind{.name = "axis.zero-crossing",
               .scope = Scope::axis,
               .keys = {{{"nT", 1, 3}}},
               .axis = [](const AxisContext& c, const Numbers& n) { return c.v() < 0 ? -n[0] : n[0]; }},
    EffectKind{
        .name = "axis.hysteresis",
        .scope = Scope::axis,
        .keys = {{{"h_nT", 1, 4}, {"width", 1, 0, 0.05, 0.4, 0.1}}},
        .build = [](const EffectKind&, const Where& where, const Numbers& n) -> std::unique_ptr<Effect> {
          return std::make_unique<AxisHysteresis>(where, n[0], n[1]);
        }},
    EffectKind{.name = "axis.settling",
               .scope = Scope::axis,
               .keys = {{{"eta_nT", 1, 10}, {"tau_s", 1, 0, 2, 8, 5}}},
               .build = [](const EffectKind&, const Where& where, const Numbers& n)
                   -> std::unique_ptr<Effect> { return std::make_unique<AxisSettling>(where, n[0], n[1]); }},
};

}  // namespace

std::span<const EffectKind> axis_kinds() { return kAxisKinds; }

}  // namespace mgtd::rig
