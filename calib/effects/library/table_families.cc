// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/table_effects.h"
#include "calib/effects/library/family_parts.h"

namespace mgtd::calib::effects::library {
namespace {

constexpr std::array kEccentricityConfusions{
    Confusion{"site.field-drift", "turns at different times"},
    Confusion{"table.wobble", "attitudes with the field away from the axis"}};
constexpr std::array kScaleConfusions{
    Confusion{"site.field-drift", "azimuth in random order: a monotone turn makes angle and time the same"}};
constexpr std::array kBacklashConfusions{
    Confusion{"axis.hysteresis", "look at the sensors: a wrong angle is in all alike"}};
constexpr std::array kWobbleConfusions{
    Confusion{"platform.flexure", "a turn common to all sensors is the table's"}};

constexpr std::array kTableFamilies{
    EffectFamily{.name = "table.eccentricity",
                 .level = Level::table,
                 .title = "the angle encoder sits off its axis",
                 .cause = "eccentric or elliptic scale with one reading head",
                 .equation = "azimuth += e1 cos az + e2 sin az + e3 cos 2az + e4 sin 2az",
                 .coefficients = "cos, sin, cos2, sin2, deg",
                 .typical = 0.02,
                 .bound = 5,
                 .source = "10 um on a radius of 50 mm are 41 arcsec",
                 .scales = kOwnScale,
                 .scan = {},
                 .needs = "azimuth_deg",
                 .signature = "no scalar residual; the attitude follows azimuth, the same in all sensors",
                 .confusions = kEccentricityConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain<laws::Eccentricity>},
    EffectFamily{
        .name = "table.angle-scale",
        .level = Level::table,
        .title = "the table turns too far or not far enough",
        .cause = "gear ratio or step count",
        .equation = "azimuth += 1e-6 kappa azimuth",
        .coefficients = "kappa, ppm",
        .typical = 100,
        .bound = 20000,
        .source = "one step in ten thousand (estimate)",
        .scales = kOwnScale,
        .scan = {},
        .needs = "azimuth_deg",
        .signature = "no scalar residual; the attitude is a ramp in azimuth with a jump at the full turn",
        .confusions = kScaleConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &plain<laws::AngleScale>},
    EffectFamily{.name = "table.backlash",
                 .level = Level::table,
                 .title = "the table stops short by the side it comes from",
                 .cause = "play of the gear",
                 .equation = "azimuth += beta sense, sense = +1 or -1 of the last approach",
                 .coefficients = "beta, deg: half the play",
                 .typical = 0.02,
                 .bound = 5,
                 .source = "0.01 to 0.1 deg without a preloaded gear (estimate)",
                 .scales = kOwnScale,
                 .scan = {},
                 .needs = "sense, of nine poses in ten",
                 .signature = "no scalar residual; the attitude differs by the sense of approach",
                 .confusions = kBacklashConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain<laws::Backlash>},
    EffectFamily{
        .name = "table.wobble",
        .level = Level::table,
        .title = "the axis of the table wobbles",
        .cause = "run-out of the bearing",
        .equation = "tilt of the azimuth axis: w1 cos az + w2 sin az about X, w2 cos az - w1 sin az about Y; "
                    "the other two "
                    "combinations turn the array on the table by a fixed angle and are part of the alignment",
        .coefficients = "w1, w2, deg",
        .typical = 0.02,
        .bound = 5,
        .source = "0.005 to 0.05 deg (estimate)",
        .scales = kOwnScale,
        .scan = {},
        .needs = "azimuth_deg",
        .signature = "no scalar residual; attitude about X and Y follows azimuth, the same in all sensors",
        .confusions = kWobbleConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &plain<laws::Wobble>},
};

}  // namespace

std::span<const EffectFamily> table_families() { return kTableFamilies; }

}  // namespace mgtd::calib::effects::library
