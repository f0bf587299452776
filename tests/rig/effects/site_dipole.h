// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <nlohmann/json.hpp>

#include "tests/rig/effect.h"
#include "tests/rig/vehicle.h"

namespace mgtd::rig {

/// A piece of iron stands near the table.
class SiteDipole final : public EffectOf<SiteDipole> {
 public:
  SiteDipole(const std::array<double, 3>& moment_Am2, const std::array<double, 3>& at_m)
      : moment_Am2_(moment_Am2.data()), at_m_(at_m.data()) {}
  [[nodiscard]] Eigen::Vector3d site_nT(double, const Eigen::Vector3d& x_m) const override {
    return dipole_nT(moment_Am2_, x_m - at_m_);
  }
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "site.dipole"},
            {"moment_Am2", {moment_Am2_[0], moment_Am2_[1], moment_Am2_[2]}},
            {"at_m", {at_m_[0], at_m_[1], at_m_[2]}}};
  }

 private:
  Eigen::Vector3d moment_Am2_, at_m_;
};

}  // namespace mgtd::rig
