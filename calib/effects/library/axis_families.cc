// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/axis_gain.h"
#include "calib/effects/laws/axis_offset.h"
#include "calib/effects/library/family_parts.h"

namespace mgtd::calib::effects::library {
namespace {

Result<EffectPtr> offset_step(const EffectSpec& spec) {
  return axis_with(spec, "ts", &laws::OffsetStep::ts_h, -1e6, 1e6);
}
Result<EffectPtr> gain_step(const EffectSpec& spec) {
  return axis_with(spec, "c", &laws::GainStep::c_nT, 0, 1e6);
}

constexpr Scan kStepTime{
    .parameter = "ts", .unit = "h", .from = 0, .to = 1, .steps = 40, .range = Scan::Range::run};

constexpr std::array kOffsetTemperatureConfusions{
    Confusion{"axis.offset.drift", "warming the room and cooling it again within the run: time goes one way"},
    Confusion{"axis.offset.temperature2", "a wider range of temperature, on both sides of 20 degC"}};
constexpr std::array kOffsetTemperature2Confusions{
    Confusion{"axis.offset.temperature", "temperatures on both sides of 20 degC"}};
constexpr std::array kOffsetDriftConfusions{
    Confusion{"axis.offset.temperature", "a heat pulse: up and down again while time goes on"},
    Confusion{"axis.offset.step", "poses repeated at even times through the run"},
    Confusion{"site.field-drift", "a scalar reference; a drift of the site is the same in all sensors"}};
constexpr std::array kOffsetStepConfusions{
    Confusion{"axis.offset.drift", "poses repeated through the run"},
    Confusion{"site.gradient-drift", "look at the other sensors: a step of the site is in all of them"}};
constexpr std::array kGainTemperatureConfusions{
    Confusion{"axis.gain.drift", "a heat pulse, up and down"},
    Confusion{"axis.offset.temperature", "both directions of the field along the axis at each temperature"}};
constexpr std::array kGainTemperature2Confusions{
    Confusion{"axis.gain.temperature", "temperatures on both sides of 20 degC"}};
constexpr std::array kGainDriftConfusions{
    Confusion{"axis.gain.temperature", "a heat pulse, up and down"},
    Confusion{"site.field-drift",
              "a scalar reference: a gain common to all axes is a change of the field without one"}};
constexpr std::array kGainStepConfusions{
    Confusion{"axis.cubic", "poses at many sizes of the axis' own reading, or another field strength"}};

constexpr std::array kAxisFamilies{
    EffectFamily{
        .name = "axis.offset.temperature",
        .level = Level::axis,
        .title = "offset follows temperature",
        .cause =
            "core and electronics change with temperature: stresses in the core, bias currents, reference",
        .equation = "y += alpha (T - 20 degC)",
        .coefficients = "alpha, nT/degC, one an axis",
        .typical = 0.3,
        .bound = 20,
        .source = "0.01 to 0.5 nT/degC good heads, up to 5 low-cost ones (estimate); 1 nT through an eclipse "
                  "on MMS",
        .scales = kAxisScales,
        .scan = {},
        .needs = "T_degC",
        .signature =
            "the residual of an axis follows its temperature and is the same in all directions of the field",
        .confusions = kOffsetTemperatureConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &plain_axis<laws::OffsetTemperature>},
    EffectFamily{
        .name = "axis.offset.temperature2",
        .level = Level::axis,
        .title = "offset bends with temperature",
        .cause = "the temperature law of core and electronics is not straight",
        .equation = "y += alpha2 (T - 20 degC)^2",
        .coefficients = "alpha2, nT/degC^2, one an axis",
        .typical = 0.02,
        .bound = 2,
        .source = "a tenth of the straight law over 3 degC (estimate)",
        .scales = kAxisScales,
        .scan = {},
        .needs = "T_degC",
        .signature =
            "a parabola of the residual against temperature, the same in all directions of the field",
        .confusions = kOffsetTemperature2Confusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &plain_axis<laws::OffsetTemperature2>},
    EffectFamily{.name = "axis.offset.drift",
                 .level = Level::axis,
                 .title = "offset drifts with time",
                 .cause = "ageing and warming up of the electronics",
                 .equation = "y += delta (t - t0)",
                 .coefficients = "delta, nT/h, one an axis",
                 .typical = 1,
                 .bound = 50,
                 .source = "0.1 to 5 nT/h (estimate); 0.2 nT/h was required of THEMIS",
                 .scales = kAxisScales,
                 .scan = {},
                 .needs = "t_s",
                 .signature = "the residual of an axis grows with time and does not depend on the field",
                 .confusions = kOffsetDriftConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain_axis<laws::OffsetDrift>},
    EffectFamily{.name = "axis.offset.step",
                 .level = Level::axis,
                 .title = "offset jumped",
                 .cause = "a connector, a knock, a magnet near the head: the core keeps another remanence",
                 .equation = "y += s [t >= ts]",
                 .coefficients = "s, nT, one an axis",
                 .typical = 2,
                 .bound = 1000,
                 .source = "0.5 to 50 nT after a strong field or a knock (estimate)",
                 .scales = kAxisScales,
                 .scan = kStepTime,
                 .needs = "t_s",
                 .signature = "the residual has one level before ts and another behind it",
                 .confusions = kOffsetStepConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &offset_step},
    EffectFamily{.name = "axis.gain.temperature",
                 .level = Level::axis,
                 .title = "scale factor follows temperature",
                 .cause = "the feedback coil grows and the reference voltage moves with temperature",
                 .equation = "y += 1e-6 kappa (T - 20 degC) v",
                 .coefficients = "kappa, ppm/degC, one an axis",
                 .typical = 20,
                 .bound = 500,
                 .source = "8 to 30 ppm/degC (27.7 to 29.1 on Swarm); closed-loop class below 100",
                 .scales = kAxisScales,
                 .scan = {},
                 .needs = "T_degC",
                 .signature = "follows temperature, with the sign of the axis' own field",
                 .confusions = kGainTemperatureConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain_axis<laws::GainTemperature>},
    EffectFamily{.name = "axis.gain.temperature2",
                 .level = Level::axis,
                 .title = "scale factor bends with temperature",
                 .cause = "the temperature law of coil and reference is not straight",
                 .equation = "y += 1e-6 kappa2 (T - 20 degC)^2 v",
                 .coefficients = "kappa2, ppm/degC^2, one an axis",
                 .typical = 1,
                 .bound = 50,
                 .source = "a tenth of the straight law over 3 degC (estimate)",
                 .scales = kAxisScales,
                 .scan = {},
                 .needs = "T_degC",
                 .signature = "a parabola against temperature, with the sign of the axis' own field",
                 .confusions = kGainTemperature2Confusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain_axis<laws::GainTemperature2>},
    EffectFamily{
        .name = "axis.gain.drift",
        .level = Level::axis,
        .title = "scale factor drifts with time",
        .cause = "the reference voltage of electronics or digitiser ages or warms up",
        .equation = "y += 1e-6 g (t - t0) v",
        .coefficients = "g, ppm/h, one an axis",
        .typical = 5,
        .bound = 200,
        .source = "1 to 20 ppm/h (estimate)",
        .scales = kAxisScales,
        .scan = {},
        .needs = "t_s",
        .signature = "grows with time, with the sign of the axis' own field; axes of one digitiser share it",
        .confusions = kGainDriftConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &plain_axis<laws::GainDrift>},
    EffectFamily{.name = "axis.gain.step",
                 .level = Level::axis,
                 .title = "scale factor changes at a reading",
                 .cause = "a range switch, or the digitiser's integral nonlinearity",
                 .equation = "y += 1e-6 g v [|v| > c]",
                 .coefficients = "g, ppm, one an axis",
                 .typical = 50,
                 .bound = 5000,
                 .source = "15 to 100 ppm of full scale by data sheets (estimate)",
                 .scales = kAxisScales,
                 .scan = Scan{.parameter = "c", .unit = "nT", .from = 5000, .to = 45000, .steps = 17},
                 .needs = {},
                 .signature = "odd in the axis' own reading, with a jump at plus and minus c",
                 .confusions = kGainStepConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &gain_step},
};

}  // namespace

std::span<const EffectFamily> axis_families() { return kAxisFamilies; }

}  // namespace mgtd::calib::effects::library
