// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "tests/rig/effect.h"

namespace mgtd::rig {

/// Something of iron near the table: B += mu0/4pi (3 (m.u) u - m)/d^3 with d u = x - x_d; 100 nT at 1 m for
/// 1 A m2 across the moment.
class SiteDipole final : public EffectOf<SiteDipole> {
 public:
  SiteDipole(const std::array<double, 3>& moment_Am2, const std::array<double, 3>& at_m)
      : moment_Am2_(moment_Am2.data()), at_m_(at_m.data()) {}
  [[nodiscard]] Eigen::Vector3d site_nT(double, const Eigen::Vector3d& x_m) const override {
    const Eigen::Vector3d d = x_m - at_m_;
    const Eigen::Vector3d u = d.normalized();
    return kMu0Over4Pi_nT * (3 * moment_Am2_.dot(u) * u - moment_Am2_) / (d.norm() * d.squaredNorm());
  }
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "site.dipole"},
            {"moment_Am2", {moment_Am2_[0], moment_Am2_[1], moment_Am2_[2]}},
            {"at_m", {at_m_[0], at_m_[1], at_m_[2]}}};
  }

 private:
  static constexpr double kMu0Over4Pi_nT = 100;  // 1e-7 T m/A in nT
  Eigen::Vector3d moment_Am2_, at_m_;
};

}  // namespace mgtd::rig
