// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effect_kind.h"
#include "tests/rig/rotations.h"

/// Effects of the platform: fields that turn with the array, and sensors that turn on it.
namespace mgtd::rig {
namespace {

constexpr double kArcsec = kDeg / 3600;

Eigen::Matrix3d matrix(const Numbers& n) {
  return Eigen::Matrix3d{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}};
}

/// The neighbours' compensation coils: dipoles of moment proportional to the field they null.
Eigen::Vector3d crosstalk(const PlatformContext& c, const Numbers& n) {
  Eigen::Vector3d out(0, 0, 0);
  const auto i = static_cast<std::size_t>(c.sensor);
  for (std::size_t j = 0; j < c.b_nT.size(); ++j) {
    if (j == i) continue;
    const Eigen::Vector3d r = c.position_m[i] - c.position_m[j];
    const Eigen::Vector3d u = r.normalized(), b = c.b_nT[j];
    out += n[0] / (r.squaredNorm() * r.norm()) * (3 * b.dot(u) * u - b);
  }
  return out;
}

constexpr std::array kPlatformKinds{
    EffectKind{.name = "platform.current",
               .scope = Scope::sensor,
               .keys = {{{"nT_per_A", 3, 4}}},
               .needs_covariate = true,
               .platform = [](const PlatformContext&, const Numbers& n) -> Eigen::Vector3d {
                 return n.covariate * n.vector();
               }},
    // omega = S g, S row by row
    EffectKind{.name = "platform.flexure",
               .scope = Scope::sensor,
               .keys = {{{"deg", 9, 0.01}}},
               .turn_rad = [](const PlatformContext& c, const Numbers& n) -> Eigen::Vector3d {
                 return kDeg * (matrix(n) * c.g);
               }},
    EffectKind{.name = "platform.thermal-bending",
               .scope = Scope::sensor,
               .keys = {{{"arcsec_per_degC", 3, 12}}},
               .turn_rad = [](const PlatformContext& c, const Numbers& n) -> Eigen::Vector3d {
                 return kArcsec * (c.T_degC - kT0_degC) * n.vector();
               }},
    // fixed to the table while the array is mounted on it in different ways
    EffectKind{.name = "platform.tabletop-magnet",
               .scope = Scope::sensor,
               .keys = {{{"nT", 3, 5}}},
               .platform = [](const PlatformContext& c, const Numbers& n) -> Eigen::Vector3d {
                 return c.mount * n.vector();
               }},
    EffectKind{
        .name = "platform.hard-iron",
        .scope = Scope::sensor,
        .keys = {{{"nT", 3, 50}}},
        .platform = [](const PlatformContext&, const Numbers& n) -> Eigen::Vector3d { return n.vector(); }},
    EffectKind{.name = "platform.soft-iron",
               .scope = Scope::sensor,
               .keys = {{{"share", 9, 0.001}}},
               .platform = [](const PlatformContext& c, const Numbers& n) -> Eigen::Vector3d {
                 return matrix(n) * c.b_nT[static_cast<std::size_t>(c.sensor)];
               }},
    EffectKind{.name = "platform.crosstalk",
               .scope = Scope::sensor,
               .keys = {{{"kappa_m3", 1, 3.4e-6}}},
               .platform = &crosstalk},
};

}  // namespace

std::span<const EffectKind> platform_kinds() { return kPlatformKinds; }

}  // namespace mgtd::rig
