// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effect_kind.h"
#include "tests/rig/effects/site_dipole.h"
#include "tests/rig/effects/site_gradient.h"

/// Effects of the site, and of what measures its magnitude.
namespace mgtd::rig {
namespace {

SiteGradient::Five five(const Numbers& n) { return {n[0], n[1], n[2], n[3], n[4]}; }
std::array<double, 3> three(const Numbers& n, std::size_t first) {
  return {n[first], n[first + 1], n[first + 2]};
}

/// B_i = 1/2 H_ijk x_j x_k with H symmetric and every trace zero: the field of a harmonic potential of degree
/// three. Given as xxx, xxy, xxz, xyy, xyz, yyy, yyz.
Eigen::Vector3d curvature(double, const Eigen::Vector3d& p, const Numbers& n) {
  const double x = p[0], y = p[1], z = p[2];
  const double xxx = n[0], xxy = n[1], xxz = n[2], xyy = n[3], xyz = n[4], yyy = n[5], yyz = n[6];
  const double xzz = -xxx - xyy, yzz = -xxy - yyy, zzz = -xxz - yyz;
  return 0.5 * Eigen::Vector3d(
                   xxx * x * x + xyy * y * y + xzz * z * z + 2 * (xxy * x * y + xxz * x * z + xyz * y * z),
                   xxy * x * x + yyy * y * y + yzz * z * z + 2 * (xyy * x * y + xyz * x * z + yyz * y * z),
                   xxz * x * x + yyz * y * y + zzz * z * z + 2 * (xyz * x * y + xzz * x * z + yzz * y * z));
}

constexpr std::array kSiteKinds{
    EffectKind{.name = "site.gradient",  // xx, yy, xy, xz, yz
               .keys = {{{"nT_per_m", 5, 20}}},
               .build = [](const EffectKind&, const Where&, const Numbers& n) -> std::unique_ptr<Effect> {
                 return std::make_unique<SiteGradient>(five(n), SiteGradient::Five{});
               }},
    EffectKind{.name = "site.gradient-drift",
               .keys = {{{"nT_per_m_per_h", 5, 40}}},
               .build = [](const EffectKind&, const Where&, const Numbers& n) -> std::unique_ptr<Effect> {
                 return std::make_unique<SiteGradient>(SiteGradient::Five{}, five(n));
               }},
    EffectKind{.name = "site.gradient-step",
               .keys = {{{"nT_per_m", 5, 30}, {"at_s", 1, 0, 400, 1600}}},
               .site = [](double t_s, const Eigen::Vector3d& x_m, const Numbers& n) -> Eigen::Vector3d {
                 if (t_s < n[5]) return {0, 0, 0};
                 return SiteGradient(five(n), SiteGradient::Five{}).site_nT(0, x_m);
               }},
    EffectKind{.name = "site.curvature", .keys = {{{"nT_per_m2", 7, 150}}}, .site = &curvature},
    EffectKind{.name = "site.dipole",
               .keys = {{{"moment_Am2", 3, 3}, {"at_m", 3, 0, 0.7, 1.2}}},
               .build = [](const EffectKind&, const Where&, const Numbers& n) -> std::unique_ptr<Effect> {
                 return std::make_unique<SiteDipole>(three(n, 0), three(n, 3));
               }},
    EffectKind{.name = "site.field-drift",
               .keys = {{{"nT_per_h", 3, 20}, {"nT_per_h2", 3, 0, 0, 0, 0}}},
               .site = [](double t_s, const Eigen::Vector3d&, const Numbers& n) -> Eigen::Vector3d {
                 const double hours = t_s / 3600;
                 return hours * n.vector() + hours * hours * n.vector(3);
               }},
    EffectKind{
        .name = "site.reference-error",  // a constant, and what follows the array's attitude
        .keys = {{{"nT", 1, 0, 0, 0, 0}, {"heading_nT", 3, 1}}},
        .reference = [](const Eigen::Vector3d& u, const Numbers& n) { return n[0] + n.vector(1).dot(u); }},
};

}  // namespace

std::span<const EffectKind> site_kinds() { return kSiteKinds; }

}  // namespace mgtd::rig
