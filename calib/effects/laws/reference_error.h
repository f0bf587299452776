// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/laws/site_effect.h"

/// `site.reference-error` is the heading error of a scalar reference that rides on the platform.
///
///     f = |B(0)| + k u + u' K u,   u = direction of the field in the platform frame
///     k: kx ky kz;  K symmetric and traceless: kxx kyy kxy kxz kyz;  all in nT
///
/// A constant error of the reference is a common error of all scale factors and no residual shows it. A
/// reference that stands still beside the table has no heading of its own.
namespace mgtd::calib::effects::laws {

class ReferenceError final : public SiteEffect<ReferenceError> {
 public:
  static constexpr std::string_view kName = "site.reference-error";
  ReferenceError() {
    for (const char* name : {"kx", "ky", "kz", "kxx", "kyy", "kxy", "kxz", "kyz"}) add(name, "nT", 0.5, 50);
  }
  [[nodiscard]] Level level() const override { return Level::reference; }
  [[nodiscard]] std::string_view missing(const Pose& pose) const override {
    return pose.f_nT ? missing_angle(pose) : "f_nT";
  }
  template <class S>
  void equation(const Conditions&, int, std::span<const S> u, std::span<const S> k, std::span<S> out) const {
    out[0] = k[0] * u[0] + k[1] * u[1] + k[2] * u[2] + k[3] * (u[0] * u[0] - u[2] * u[2]) +
             k[4] * (u[1] * u[1] - u[2] * u[2]) +
             S(2.0) * (k[5] * u[0] * u[1] + k[6] * u[0] * u[2] + k[7] * u[1] * u[2]);
  }
};

}  // namespace mgtd::calib::effects::laws
