// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/reference_error.h"
#include "calib/effects/laws/site_curvature.h"
#include "calib/effects/laws/site_dipole.h"
#include "calib/effects/laws/site_drift.h"
#include "calib/effects/laws/site_gradient.h"
#include "calib/effects/laws/site_step.h"
#include "calib/effects/library/family_parts.h"

namespace mgtd::calib::effects::library {
namespace {

Result<EffectPtr> dipole(const EffectSpec& spec) {
  if (const auto ok = spec.only({"place", "x", "y", "z"}); !ok) return tl::unexpected(ok.error());
  if (const auto where = where_of(spec, kOwnScale); !where) return tl::unexpected(where.error());
  if (spec.find("place") != nullptr) {
    const auto place = spec.number("place", 0, 0, laws::kDipolePlaces - 1);
    if (!place) return tl::unexpected(place.error());
    return std::make_shared<const laws::SiteDipole>(laws::dipole_place_S_m(static_cast<int>(*place)));
  }
  if (spec.parameters.empty()) return std::make_shared<const laws::SiteDipole>(std::nullopt);
  const auto at = laws::dipole_place_S_m(spec);
  if (!at) return tl::unexpected(at.error());
  return std::make_shared<const laws::SiteDipole>(*at);
}

Result<EffectPtr> step(const EffectSpec& spec) {
  if (const auto ok = spec.only({"ts", "x", "y", "z"}); !ok) return tl::unexpected(ok.error());
  if (const auto where = where_of(spec, kOwnScale); !where) return tl::unexpected(where.error());
  const auto ts_h = spec.number("ts", 0, -1e6, 1e6);
  if (!ts_h) return tl::unexpected(ts_h.error());
  if (spec.find("x") == nullptr && spec.find("y") == nullptr && spec.find("z") == nullptr)
    return std::make_shared<const laws::SiteStep>(spec.find("ts") != nullptr ? std::optional(*ts_h)
                                                                             : std::nullopt);
  const auto at = laws::dipole_place_S_m(spec);
  if (!at) return tl::unexpected(at.error());
  return std::make_shared<const laws::SiteStepDipole>(*ts_h, *at);
}

/// An effect with one optional number.
template <class E>
Result<EffectPtr> with_optional(const EffectSpec& spec, std::string_view parameter, double lowest) {
  if (const auto ok = spec.only({parameter}); !ok) return tl::unexpected(ok.error());
  if (const auto where = where_of(spec, kOwnScale); !where) return tl::unexpected(where.error());
  const auto value = spec.number(parameter, 0, lowest, 1e6);
  if (!value) return tl::unexpected(value.error());
  return std::make_shared<const E>(spec.find(parameter) != nullptr ? std::optional(*value) : std::nullopt);
}
Result<EffectPtr> field_drift(const EffectSpec& spec) {
  return with_optional<laws::FieldDrift>(spec, "hours", 1e-6);
}
Result<EffectPtr> gradient_drift(const EffectSpec& spec) {
  return with_optional<laws::GradientDrift>(spec, "ts", -1e6);
}

constexpr std::array kGradientConfusions{
    Confusion{"site.dipole", "closure of the cross, or the base of the table moved by half a metre"},
    Confusion{"platform.tabletop-magnet",
              "turn the base of the table: a gradient stays, a magnet on it goes along"}};
constexpr std::array kCurvatureConfusions{Confusion{
    "site.dipole", "move the base: the curvature of a dipole falls with the fifth power of distance"}};
constexpr std::array kDipoleConfusions{
    Confusion{"site.gradient", "poses that bring a sensor close to it; move the base by half a metre"},
    Confusion{"site.curvature", "the same"}};
constexpr std::array kFieldDriftConfusions{
    Confusion{"axis.gain.drift", "a scalar reference beside the table"},
    Confusion{"axis.offset.drift", "a change of the site is the same in all sensors"}};
constexpr std::array kGradientDriftConfusions{Confusion{
    "axis.offset.drift", "many attitudes at each time: a gradient turns with the array, an offset does not"}};
constexpr std::array kStepConfusions{
    Confusion{"site.gradient-drift", "poses that follow each other quickly about the moment"},
    Confusion{"axis.offset.step", "a step of the site is seen by all sensors and turns with the array"}};
constexpr std::array kReferenceConfusions{Confusion{
    "axis.gain.drift", "a second scalar reference; an error that never changes is the scale of all axes"}};

constexpr std::array kSiteFamilies{
    EffectFamily{.name = "site.gradient",
                 .level = Level::site,
                 .title = "the field of the site is not uniform",
                 .cause = "geology, buildings and iron tens of metres away",
                 .equation = "B(x) += G x, G symmetric and traceless, site frame",
                 .coefficients = "Gxx, Gyy, Gxy, Gxz, Gyz, nT/m",
                 .typical = 20,
                 .bound = 5000,
                 .source = "10 to 1000 nT/m in and near buildings (estimate)",
                 .scales = kOwnScale,
                 .scan = {},
                 .needs = "azimuth_deg",
                 .signature = "once per turn and opposite in opposite sensors; no closure error",
                 .confusions = kGradientConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain<laws::SiteGradient>},
    EffectFamily{.name = "site.curvature",
                 .level = Level::site,
                 .title = "the gradient of the site changes over the cross",
                 .cause = "iron a metre or two away",
                 .equation = "B_i += 1/2 H_ijk x_j x_k, H symmetric and traceless, site frame",
                 .coefficients = "Hxxx, Hxxy, Hxxz, Hxyy, Hxyz, Hyyy, Hyyz, nT/m^2",
                 .typical = 50,
                 .bound = 50000,
                 .source = "a dipole of 1 A m^2 at 1 m: 600 nT/m and 2400 nT/m^2",
                 .scales = kOwnScale,
                 .scan = {},
                 .needs = "azimuth_deg",
                 .signature = "twice per turn and alike in opposite sensors; the closure of the cross fails",
                 .confusions = kCurvatureConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &plain<laws::SiteCurvature>},
    EffectFamily{
        .name = "site.dipole",
        .level = Level::site,
        .title = "a magnet near the array",
        .cause = "a motor, a tool, a parked trolley, a magnet fixed to the base of the table",
        .equation = "B(x) += D(x) - D(0), D(x) = 100 (3 (m.u) u - m)/d^3 nT, u d = x - place - shift, site "
                    "frame, metres",
        .coefficients = "mx, my, mz, A m^2; dx, dy, dz, m from the best place of a grid (or of x=, y=, z=)",
        .typical = 0.1,
        .bound = 1000,
        .source = "a screw 0.01, a hand tool 0.1, a motor 1 A m^2; 1 A m^2 at 1 m is 200 nT",
        .scales = kOwnScale,
        .scan = Scan{.parameter = "place",
                     .unit = "",
                     .from = 0,
                     .to = laws::kDipolePlaces - 1,
                     .steps = laws::kDipolePlaces,
                     .range = Scan::Range::index},
        .needs = "azimuth_deg",
        .signature = "like a gradient with a curvature; strongest in the sensor that passes nearest",
        .confusions = kDipoleConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &dipole},
    EffectFamily{
        .name = "site.field-drift",
        .level = Level::site,
        .title = "the field of the site changes during the run",
        .cause = "daily variation, magnetic storms, trains",
        .equation = "B += sum of c_k cos(k pi t/D), k = 1 to 3, D the length of the run",
        .coefficients = "cos1.x to cos3.z, nT, site frame",
        .typical = 20,
        .bound = 2000,
        .source = "tens of nT on a quiet day, hundreds within minutes in a storm",
        .scales = kOwnScale,
        .scan = {},
        .needs = "t_s",
        .signature =
            "the same in all sensors. With a scalar reference the strength is measured pose by pose and "
            "only the direction is left to tell",
        .confusions = kFieldDriftConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &field_drift},
    EffectFamily{.name = "site.gradient-drift",
                 .level = Level::site,
                 .title = "the gradient of the site changes during the run",
                 .cause = "iron that moves slowly: a store that fills, a crane, a machine that warms up",
                 .equation = "G += G' (t - t0); with ts: G += dG [t >= ts]",
                 .coefficients = "Gxx, Gyy, Gxy, Gxz, Gyz, nT/m/h; with ts nT/m",
                 .typical = 10,
                 .bound = 2000,
                 .source = "a car at 10 m: some nT/m (estimate)",
                 .scales = kOwnScale,
                 .scan = {},
                 .needs = "t_s",
                 .signature = "a gradient that grows with time",
                 .confusions = kGradientDriftConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &gradient_drift},
    EffectFamily{
        .name = "site.step",
        .level = Level::site,
        .title = "something magnetic came to the site or left it",
        .cause = "a parked car, a tool put down, a door of steel, a crane",
        .equation = "B(x) += dB + dG x from ts on; with x, y, z a dipole from ts on",
        .coefficients =
            "Bx, By, Bz, nT; Gxx, Gyy, Gxy, Gxz, Gyz, nT/m; or mx, my, mz, A m^2, and dx, dy, dz, m",
        .typical = 20,
        .bound = 5000,
        .source = "a car at 10 m: some nT and some nT/m; a magnet of 1 A m^2 at 1 m: 200 nT and 600 nT/m",
        .scales = kOwnScale,
        .scan = Scan{.parameter = "ts",
                     .unit = "h",
                     .from = 0.05,
                     .to = 0.95,
                     .steps = 19,
                     .range = Scan::Range::run},
        .needs = "t_s",
        .signature = "a gradient that appears at one moment in all sensors. With a scalar reference the "
                     "strength of the field is measured pose by pose and only its turn is left to tell",
        .confusions = kStepConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &step},
    EffectFamily{
        .name = "site.reference-error",
        .level = Level::reference,
        .title = "the scalar reference reads differently by direction",
        .cause = "heading error of a magnetometer that rides on the platform, or its own iron",
        .equation = "f += k u + u' K u, u = direction of the field in the platform frame",
        .coefficients = "kx, ky, kz, kxx, kyy, kxy, kxz, kyz, nT",
        .typical = 0.5,
        .bound = 50,
        .source = "0.05 to 1 nT for proton and caesium magnetometers (estimate)",
        .scales = kOwnScale,
        .scan = {},
        .needs = "f_nT",
        .signature =
            "nearly that of offsets and matrices common to all sensors, held apart by the angles of "
            "the table only. A constant error is a common error of all scale factors: no residual shows it",
        .confusions = kReferenceConfusions,
        .untestable = {},
        .experiment = "a second scalar reference, read side by side",
        .from_spec = &plain<laws::ReferenceError>},
};

}  // namespace

std::span<const EffectFamily> site_families() { return kSiteFamilies; }

}  // namespace mgtd::calib::effects::library
