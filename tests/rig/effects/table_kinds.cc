// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "tests/rig/effect_kind.h"
#include "tests/rig/rotations.h"

/// Effects of the table: where it truly stands.
namespace mgtd::rig {
namespace {

double turn(const TableContext& c) { return c.angle_deg[0] * kDeg; }
TableError of_azimuth(double deg) { return {{deg, 0, 0}, 0, 0}; }

constexpr std::array kTableKinds{
    EffectKind{.name = "table.eccentricity",
               .keys = {{{"cos_deg", 1, 0.1},
                         {"sin_deg", 1, 0.1},
                         {"cos2_deg", 1, 0, 0, 0, 0},
                         {"sin2_deg", 1, 0, 0, 0, 0}}},
               .table =
                   [](const TableContext& c, const Numbers& n) {
                     const double a = turn(c);
                     return of_azimuth(n[0] * std::cos(a) + n[1] * std::sin(a) + n[2] * std::cos(2 * a) +
                                       n[3] * std::sin(2 * a));
                   }},
    EffectKind{.name = "table.angle-scale",
               .keys = {{{"ppm", 1, 1500}}},
               .table = [](const TableContext& c,
                           const Numbers& n) { return of_azimuth(1e-6 * n[0] * c.angle_deg[0]); }},
    EffectKind{
        .name = "table.backlash",
        .keys = {{{"deg", 1, 0.1}}},
        .table = [](const TableContext& c, const Numbers& n) { return of_azimuth(n[0] * c.sense[0]); }},
    EffectKind{
        .name = "table.wobble",
        .keys =
            {{{"x_cos_deg", 1, 0.1}, {"x_sin_deg", 1, 0.1}, {"y_cos_deg", 1, 0.1}, {"y_sin_deg", 1, 0.1}}},
        .table =
            [](const TableContext& c, const Numbers& n) {
              const double cos_a = std::cos(turn(c)), sin_a = std::sin(turn(c));
              return TableError{{}, n[0] * cos_a + n[1] * sin_a, n[2] * cos_a + n[3] * sin_a};
            }},
};

}  // namespace

std::span<const EffectKind> table_kinds() { return kTableKinds; }

}  // namespace mgtd::rig
