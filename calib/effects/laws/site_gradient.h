// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "calib/effects/effect.h"

/// `site.gradient` is the gradient of the site's field, which is not uniform over the array.
///
///     B(x) = B0 + G x,   G symmetric and traceless (no currents, no divergence), site frame
///     coefficients Gxx, Gyy, Gxy, Gxz, Gyz in nT/m;  Gzz = -(Gxx + Gyy)
///
/// Constant in time. Needs the attitude, hence the table angles, of every pose it acts on.
namespace mgtd::calib::effects::laws {

inline constexpr std::array<const char*, 5> kGradientComponents{"Gxx", "Gyy", "Gxy", "Gxz", "Gyz"};

/// out = G x, with g the components as kGradientComponents names them.
template <class S>
void gradient_times(std::span<const S> g, std::span<const S> x, std::span<S> out) {
  out[0] = g[0] * x[0] + g[2] * x[1] + g[3] * x[2];
  out[1] = g[2] * x[0] + g[1] * x[1] + g[4] * x[2];
  out[2] = g[3] * x[0] + g[4] * x[1] - (g[0] + g[1]) * x[2];
}

class SiteGradient final : public EffectOf<SiteGradient> {
 public:
  SiteGradient();
  [[nodiscard]] std::string_view name() const override { return "site.gradient"; }
  [[nodiscard]] Level level() const override { return Level::site; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int sensor) const override;
  [[nodiscard]] std::string_view missing(const Pose& pose) const override { return missing_angle(pose); }

  template <class S>
  void equation(const Conditions&, int, std::span<const S> x, std::span<const S> g, std::span<S> out) const {
    gradient_times(g, x, out);
  }

 private:
  std::vector<Coefficient> coefficients_;
};

}  // namespace mgtd::calib::effects::laws
