// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/laws/site_effect.h"

/// `site.curvature` is the change of the site's gradient over the array.
///
///     B_i += 1/2 H_ijk x_j x_k      nT/m^2, H symmetric in all indices and traceless: seven numbers
///     Hxzz = -(Hxxx + Hxyy), Hyzz = -(Hxxy + Hyyy), Hzzz = -(Hxxz + Hyyz)     no currents, no divergence
namespace mgtd::calib::effects::laws {

class SiteCurvature final : public SiteEffect<SiteCurvature> {
 public:
  static constexpr std::string_view kName = "site.curvature";
  SiteCurvature() {
    for (const char* name : {"Hxxx", "Hxxy", "Hxxz", "Hxyy", "Hxyz", "Hyyy", "Hyyz"}) add(name, "nT/m^2", 50);
  }
  template <class S>
  void equation(const Conditions&, int, std::span<const S> r, std::span<const S> h, std::span<S> out) const {
    const S &xxx = h[0], &xxy = h[1], &xxz = h[2], &xyy = h[3], &xyz = h[4], &yyy = h[5], &yyz = h[6];
    const S xzz = -(xxx + xyy), yzz = -(xxy + yyy), zzz = -(xxz + yyz);
    const S &x = r[0], &y = r[1], &z = r[2];
    const S half(0.5);
    out[0] = half * (xxx * x * x + xyy * y * y + xzz * z * z) + xxy * x * y + xxz * x * z + xyz * y * z;
    out[1] = half * (xxy * x * x + yyy * y * y + yzz * z * z) + xyy * x * y + xyz * x * z + yyz * y * z;
    out[2] = half * (xxz * x * x + yyz * y * y + zzz * z * z) + xyz * x * y + xzz * x * z + yzz * y * z;
  }
};

}  // namespace mgtd::calib::effects::laws
