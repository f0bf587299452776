// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/family_parts.h"
#include "calib/effects/site_gradient.h"

namespace mgtd::calib {
namespace {

constexpr std::array kGradientConfusions{
    Confusion{"site.dipole", "closure of the cross, or the base of the table moved by half a metre"},
    Confusion{"platform.tabletop-magnet",
              "turn the base of the table: a gradient stays, a magnet on it goes along"}};

constexpr std::array kFamilies{
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
                 .from_spec = &plain<SiteGradient>},
};

}  // namespace

std::span<const EffectFamily> site_families() { return kFamilies; }

}  // namespace mgtd::calib
