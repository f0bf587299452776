// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "tests/rig/effect.h"

namespace mgtd::rig {

/// B += G x, G symmetric and traceless, from (xx, yy, xy, xz, yz) in nT/m.
class SiteGradient final : public Effect {
 public:
  explicit SiteGradient(const std::array<double, 5>& g) {
    G_ << g[0], g[2], g[3], g[2], g[1], g[4], g[3], g[4], -(g[0] + g[1]);
  }
  Eigen::Vector3d site_nT(double, const Eigen::Vector3d& x_m) const override { return G_ * x_m; }
  nlohmann::json truth() const override {
    return {{"effect", "site.gradient"},
            {"nT_per_m",
             {{"xx", G_(0, 0)},
              {"yy", G_(1, 1)},
              {"zz", G_(2, 2)},
              {"xy", G_(0, 1)},
              {"xz", G_(0, 2)},
              {"yz", G_(1, 2)}}}};
  }

 private:
  Eigen::Matrix3d G_;
};

}  // namespace mgtd::rig
