// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <nlohmann/json.hpp>

#include "tests/rig/effect.h"

namespace mgtd::rig {

/// SiteGradient adds a gradient to the field of the site: B += (G + G' t) x with t in hours; G and G' are
/// symmetric and traceless, each given as (xx, yy, xy, xz, yz) in nT/m and nT/m/h.
class SiteGradient final : public EffectOf<SiteGradient> {
 public:
  using Five = std::array<double, 5>;
  /// One of the two is zero: they are effects of their own.
  SiteGradient(const Five& g, const Five& per_h) : G_(tensor(g)), per_h_(tensor(per_h)) {}
  [[nodiscard]] Eigen::Vector3d site_nT(double t_s, const Eigen::Vector3d& x_m) const override {
    return (G_ + per_h_ * (t_s / 3600)) * x_m;
  }
  [[nodiscard]] nlohmann::json truth() const override {
    if (per_h_.isZero()) return {{"effect", "site.gradient"}, {"nT_per_m", named(G_)}};
    return {{"effect", "site.gradient-drift"}, {"nT_per_m_per_h", named(per_h_)}};
  }

 private:
  static Eigen::Matrix3d tensor(const Five& g) {
    return Eigen::Matrix3d{{g[0], g[2], g[3]}, {g[2], g[1], g[4]}, {g[3], g[4], -(g[0] + g[1])}};
  }
  static nlohmann::json named(const Eigen::Matrix3d& G) {
    return {{"xx", G(0, 0)}, {"yy", G(1, 1)}, {"zz", G(2, 2)},
            {"xy", G(0, 1)}, {"xz", G(0, 2)}, {"yz", G(1, 2)}};
  }

  Eigen::Matrix3d G_, per_h_;
};

}  // namespace mgtd::rig
