// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/axis_hysteresis.h"
#include "calib/effects/laws/axis_nonlinearity.h"
#include "calib/effects/laws/axis_orthogonality.h"
#include "calib/effects/laws/axis_settling.h"
#include "calib/effects/library/family_parts.h"

namespace mgtd::calib::effects::library {
namespace {

Result<EffectPtr> hysteresis(const EffectSpec& spec) {
  return axis_with(spec, "w", &laws::Hysteresis::w, 0.001, 2);
}
Result<EffectPtr> settling(const EffectSpec& spec) {
  return axis_with(spec, "tau", &laws::Settling::tau_s, 0.01, 1e5);
}

constexpr std::array kOrthogonalityConfusions{
    Confusion{"platform.thermal-bending",
              "the angles between the axes of one sensor do not change when it turns as a whole"},
    Confusion{"axis.gain.temperature", "directions of the field across the axis as well as along it"}};
constexpr std::array kOrthogonality2Confusions{
    Confusion{"axis.orthogonality.temperature", "temperatures on both sides of 20 degC"}};
constexpr std::array kQuadraticConfusions{Confusion{"axis.transverse",
                                                    "another field strength (a coil, -20 %): at one strength "
                                                    "y^2 + z^2 = F^2 - x^2 and nothing tells them apart"}};
constexpr std::array kCubicConfusions{
    Confusion{"axis.gain.step", "poses at many sizes of the axis' own reading, or new mountings"},
    Confusion{"axis.transverse", "another field strength"}};
constexpr std::array kTransverseConfusions{
    Confusion{
        "axis.quadratic",
        "another field strength (a coil, -20 %): at one strength the squares are F^2 less the own square"},
    Confusion{"platform.flexure", "mountings tilted both ways: sag follows gravity, not the field"}};
constexpr std::array kZeroCrossingConfusions{
    Confusion{"axis.cubic", "poses with the axis' own reading near zero, on both sides"}};
constexpr std::array kHysteresisConfusions{
    Confusion{"axis.settling", "dwells of different length: the memory of the core does not fade"},
    Confusion{"table.backlash", "look at one axis: a wrong angle is in all sensors alike"}};
constexpr std::array kSettlingConfusions{
    Confusion{"axis.hysteresis", "dwells of 10, 20 and 60 s in random order: a memory does not fade"}};

constexpr std::array kNonlinearityFamilies{
    EffectFamily{.name = "axis.orthogonality.temperature",
                 .level = Level::axis,
                 .title = "the angles between the axes follow temperature",
                 .cause = "core holders and windings move against each other as the head warms",
                 .equation = "y_a += sum over b != a of chi_ab (T - 20 degC) v_b",
                 .coefficients = "chi, arcsec/degC, six a sensor (s3.zx: axis z answers to x)",
                 .typical = 1,
                 .bound = 60,
                 .source = "0.1 to 2 arcsec/degC (estimate)",
                 .scales = kAxisScales,
                 .scan = {},
                 .needs = "T_degC",
                 .signature = "follows temperature, with the sign of the field across the axis",
                 .confusions = kOrthogonalityConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain_axis<laws::OrthogonalityTemperature>},
    EffectFamily{.name = "axis.orthogonality.temperature2",
                 .level = Level::axis,
                 .title = "the angles between the axes bend with temperature",
                 .cause = "core holders and windings do not move in proportion to temperature",
                 .equation = "y_a += sum over b != a of chi2_ab (T - 20 degC)^2 v_b",
                 .coefficients = "chi2, arcsec/degC^2, six a sensor (s3.zx: axis z answers to x)",
                 .typical = 0.2,
                 .bound = 10,
                 .source = "0.02 to 0.7 arcsec/degC^2 measured on four fluxgates between 15 and 20 degC",
                 .scales = kAxisScales,
                 .scan = {},
                 .needs = "T_degC",
                 .signature = "a parabola against temperature, with the sign of the field across the axis",
                 .confusions = kOrthogonality2Confusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain_axis<laws::OrthogonalityTemperature2>},
    EffectFamily{.name = "axis.quadratic",
                 .level = Level::axis,
                 .title = "even nonlinearity of an axis",
                 .cause = "core or feedback electronics answer unequally to the two signs of the field",
                 .equation = "y += q (v/F0)^2, F0 = 50 000 nT",
                 .coefficients = "q, nT at F0, one an axis",
                 .typical = 2,
                 .bound = 100,
                 .source = "0.1 to 10 nT (estimate); quadratic and cubic together 3.2 nT on CryoSat-2",
                 .scales = kAxisScales,
                 .scan = {},
                 .needs = {},
                 .signature = "once and three times per turn in the scalar residual of one sensor",
                 .confusions = kQuadraticConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain_axis<laws::Quadratic>},
    EffectFamily{.name = "axis.cubic",
                 .level = Level::axis,
                 .title = "odd nonlinearity of an axis",
                 .cause = "finite gain of the feedback loop",
                 .equation = "y += c (v/F0)^3, F0 = 50 000 nT",
                 .coefficients = "c, nT at F0, one an axis",
                 .typical = 2,
                 .bound = 100,
                 .source = "0.1 to 10 nT; data sheets 15 to 100 ppm of full scale",
                 .scales = kAxisScales,
                 .scan = {},
                 .needs = {},
                 .signature = "twice and four times per turn; nine tenths of it are taken for a scale factor",
                 .confusions = kCubicConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain_axis<laws::Cubic>},
    EffectFamily{
        .name = "axis.transverse",
        .level = Level::axis,
        .title = "an axis answers to the field across it",
        .cause = "the field across the core changes its permeability when only the own axis is nulled",
        .equation = "y_a += tau1 (v_b^2 + v_c^2)/F0^2 + tau2 v_b v_c/F0^2",
        .coefficients = "tau1 (squares) and tau2 (product), nT at F0, two an axis",
        .typical = 2,
        .bound = 100,
        .source = "0 to 10 nT with single-axis feedback, near 0 with vector feedback (estimate)",
        .scales = kAxisScales,
        .scan = {},
        .needs = {},
        .signature = "the product twice per turn; the squares like axis.quadratic",
        .confusions = kTransverseConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &plain_axis<laws::Transverse>},
    EffectFamily{.name = "axis.zero-crossing",
                 .level = Level::axis,
                 .title = "step where the reading changes its sign",
                 .cause = "dead band of the feedback's bridge or converter",
                 .equation = "y += s sign(v)",
                 .coefficients = "s, nT, one an axis",
                 .typical = 0.5,
                 .bound = 50,
                 .source = "0.05 to 5 nT (estimate)",
                 .scales = kAxisScales,
                 .scan = {},
                 .needs = {},
                 .signature = "the residual of an axis jumps where its own reading is zero",
                 .confusions = kZeroCrossingConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain_axis<laws::ZeroCrossing>},
    EffectFamily{
        .name = "axis.hysteresis",
        .level = Level::axis,
        .title = "the core remembers where the field came from",
        .cause = "remanence of the core after the field along it has turned",
        .equation =
            "p <- max(x - w, min(x + w, p)) along the whole path from p = 0, x = v/F0; y += h (p - x)/w. "
            "A run file keeps the path of the table; a pose table knows the dwells only and misses turns "
            "that go beyond both ends",
        .coefficients = "h, nT, one an axis; w of F0 is scanned and then estimated",
        .typical = 1,
        .bound = 100,
        .source = "0.1 to 5 nT after reversals of the Earth's field, more after a magnet (estimate)",
        .scales = kAxisScales,
        .scan = Scan{.parameter = "w",
                     .unit = "F0",
                     .from = 0.02,
                     .to = 0.5,
                     .steps = 8,
                     .range = Scan::Range::logarithmic},
        .needs = {},
        .signature = "depends on the pose before; clockwise and counter-clockwise turns differ",
        .confusions = kHysteresisConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &hysteresis},
    EffectFamily{
        .name = "axis.settling",
        .level = Level::axis,
        .title = "readings creep after the table has stopped",
        .cause = "memory of a filter, self-heating after a change of direction, creep of the head's mounting",
        .equation =
            "y += eta (x_prev - x) exp(-s/tau), x = v/F0, s = since_stop_s; where the run kept the way "
            "of the table, x_prev is what a reading that lags by tau shows at the stop",
        .coefficients = "eta, nT at F0, one an axis; tau in s is scanned and then estimated",
        .typical = 2,
        .bound = 1000,
        .source = "estimate; of the order of the hysteresis",
        .scales = kAxisScales,
        .scan = Scan{.parameter = "tau",
                     .unit = "s",
                     .from = 2,
                     .to = 120,
                     .steps = 8,
                     .range = Scan::Range::logarithmic},
        .needs = "since_stop_s",
        .signature = "depends on the pose before, and less the longer the table has stood",
        .confusions = kSettlingConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &settling},
};

}  // namespace

std::span<const EffectFamily> nonlinearity_families() { return kNonlinearityFamilies; }

}  // namespace mgtd::calib::effects::library
