// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/rig/covariate.h"
#include "tests/rig/effect_kind.h"
#include "tests/rig/effects/offset_walk.h"
#include "tests/rig/effects/site_dipole.h"
#include "tests/rig/effects/thermometer_lag.h"
#include "tests/rig/rotations.h"

/// Real things that are in no library: they must be found by what they follow, and not be given a name.
namespace mgtd::rig {
namespace {

constexpr double kArcsecond = kDeg / 3600;

constexpr std::array kUnnamedKinds{
    EffectKind{
        .name = "hidden.azimuth-harmonic",  // an encoder cable, a motor's magnet geared to the table
        .scope = Scope::axis,
        .keys = {{{"nT", 1, 3}, {"per_turn", 1, 0, 0, 0, 3}, {"phase_deg", 1, 0, 0, 360, 0}}},
        .unnamed = true,
        .axis = [](const AxisContext& c,
                   const Numbers& n) { return n[0] * std::cos((n[1] * c.azimuth_deg + n[2]) * kDeg); }},
    EffectKind{.name = "hidden.lamp",  // switched by somebody who writes nothing down
               .scope = Scope::sensor,
               .keys = {{{"nT", 3, 3}, {"every_s", 1, 0, 30, 90, 40}, {"pattern", 1, 0, 1, 1e6, 1}}},
               .unnamed = true,
               .platform = [](const PlatformContext& c, const Numbers& n) -> Eigen::Vector3d {
                 return toggled(c.t_s, n[3], static_cast<std::uint64_t>(n[4])) > 0 ? n.vector()
                                                                                   : Eigen::Vector3d(0, 0, 0);
               }},
    EffectKind{.name = "hidden.battery-squared",
               .scope = Scope::axis,
               .keys = {{{"nT_per_V2", 1, 8}, {"full_V", 1, 0, 0, 0, 12.6}}},
               .needs_covariate = true,
               .unnamed = true,
               .axis =
                   [](const AxisContext&, const Numbers& n) {
                     const double down_V = n.covariate - n[1];
                     return n[0] * down_V * down_V;
                   }},
    EffectKind{.name = "hidden.offset-walk",
               .scope = Scope::axis,
               .keys = {{{"nT_per_sqrt_h", 1, 5}}},
               .unnamed = true,
               .build = [](const EffectKind&, const Where& where, const Numbers& n)
                   -> std::unique_ptr<Effect> { return std::make_unique<OffsetWalk>(where, n[0]); }},
    EffectKind{.name = "hidden.site-oscillation",
               .keys = {{{"nT", 3, 5}, {"period_s", 1, 0, 200, 900, 600}}},
               .unnamed = true,
               .site = [](double t_s, const Eigen::Vector3d&, const Numbers& n) -> Eigen::Vector3d {
                 return std::sin(2 * std::numbers::pi * t_s / n[3]) * n.vector();
               }},
    EffectKind{.name = "hidden.gradient-oscillation",  // a lift, a crane: along one line
               .keys = {{{"nT_per_m", 1, 30}, {"period_s", 1, 0, 200, 900, 600}}},
               .unnamed = true,
               .site = [](double t_s, const Eigen::Vector3d& x_m, const Numbers& n) -> Eigen::Vector3d {
                 const double g = n[0] * std::sin(2 * std::numbers::pi * t_s / n[1]);
                 return {g * x_m[0], -g * x_m[1], 0};
               }},
    EffectKind{.name = "hidden.quartic",
               .scope = Scope::axis,
               .keys = {{{"nT_at_F0", 1, 12}}},
               .unnamed = true,
               .axis = [](const AxisContext& c, const Numbers& n) { return n[0] * std::pow(c.x(), 4); }},
    EffectKind{
        .name = "hidden.cross-cubic",  // x^2 times the next axis
        .scope = Scope::axis,
        .keys = {{{"nT_at_F0", 1, 10}}},
        .unnamed = true,
        .axis = [](const AxisContext& c, const Numbers& n) { return n[0] * c.x() * c.x() * c.other(0); }},
    EffectKind{.name = "hidden.soft-limit",  // only beyond a limit, and one side only
               .scope = Scope::axis,
               .keys = {{{"nT", 1, 40}, {"above", 1, 0, 0.5, 0.8, 0.7}}},
               .unnamed = true,
               .axis =
                   [](const AxisContext& c, const Numbers& n) {
                     const double over = std::max(0.0, c.x() - n[1]);
                     return -n[0] * over * over;
                   }},
    EffectKind{.name = "hidden.warm-up",
               .scope = Scope::axis,
               .keys = {{{"nT", 1, 4}, {"tau_s", 1, 0, 200, 900, 400}}},
               .unnamed = true,
               .axis = [](const AxisContext& c, const Numbers& n) { return n[0] * std::exp(-c.t_s / n[1]); }},
    EffectKind{
        .name = "hidden.thermometer-lag",
        .scope = Scope::axis,
        .keys = {{{"nT_per_degC", 1, 3}, {"tau_s", 1, 0, 300, 1200, 600}}},
        .unnamed = true,
        .build = [](const EffectKind&, const Where& where, const Numbers& n) -> std::unique_ptr<Effect> {
          return std::make_unique<ThermometerLag>(where, n[0], n[1]);
        }},
    EffectKind{.name = "hidden.slip",  // a sensor that moved in its seat
               .scope = Scope::sensor,
               .keys = {{{"arcsec", 3, 20}, {"at_s", 1, 0, 400, 1600}}},
               .unnamed = true,
               .turn_rad = [](const PlatformContext& c, const Numbers& n) -> Eigen::Vector3d {
                 return c.t_s < n[3] ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(kArcsecond * n.vector());
               }},
    EffectKind{.name = "hidden.gravity-offset",  // a board that bends
               .scope = Scope::axis,
               .keys = {{{"nT", 3, 3}}},
               .unnamed = true,
               .axis = [](const AxisContext& c, const Numbers& n) { return n.vector().dot(c.g); }},
    EffectKind{.name = "hidden.cable-twist",
               .scope = Scope::axis,
               .keys = {{{"nT_per_turn", 1, 5}}},
               .unnamed = true,
               .axis = [](const AxisContext& c, const Numbers& n) { return n[0] * c.azimuth_deg / 360; }},
    EffectKind{.name = "hidden.passing-iron",  // a car on the road, nearest at at_s
               .keys = {{{"moment_Am2", 3, 60},
                         {"nearest_m", 3, 0, 2, 3},
                         {"m_per_s", 1, 0, 0.02, 0.05, 0.03},
                         {"at_s", 1, 0, 400, 1600}}},
               .unnamed = true,
               .site = [](double t_s, const Eigen::Vector3d& x_m, const Numbers& n) -> Eigen::Vector3d {
                 // It drives at right angles to the line towards it, horizontally.
                 const Eigen::Vector3d nearest = n.vector(3);
                 const Eigen::Vector3d along =
                     nearest.cross(Eigen::Vector3d::UnitZ()).normalized() * n[6] * (t_s - n[7]);
                 return SiteDipole({n[0], n[1], n[2]},
                                   {nearest[0] + along[0], nearest[1] + along[1], nearest[2]})
                     .site_nT(t_s, x_m);
               }},
    EffectKind{.name = "hidden.neighbour",  // what the next sensor sees along x, to some power, couples in
               .scope = Scope::sensor,
               .keys = {{{"nT_at_F0", 3, 5}, {"power", 1, 0, 0, 0, 2}}},
               .unnamed = true,
               .platform = [](const PlatformContext& c, const Numbers& n) -> Eigen::Vector3d {
                 const auto next = static_cast<std::size_t>(c.sensor + 1) % c.b_nT.size();
                 return std::pow(c.b_nT[next][0] / kF0_nT, n[3]) * n.vector();
               }},
    EffectKind{.name = "hidden.beat",  // two excitation frequencies nearly alike
               .scope = Scope::axis,
               .keys = {{{"nT", 1, 5}, {"period_s", 1, 0, 15, 60, 37}}},
               .unnamed = true,
               .axis = [](const AxisContext& c,
                          const Numbers& n) { return n[0] * std::sin(2 * std::numbers::pi * c.t_s / n[1]); }},
};

}  // namespace

std::span<const EffectKind> unnamed_kinds() { return kUnnamedKinds; }

}  // namespace mgtd::rig
