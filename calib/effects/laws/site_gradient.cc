// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/site_gradient.h"

#include <array>

namespace mgtd::calib::effects::laws {
namespace {
constexpr double kTypical_nT_per_m = 20;  // geology and buildings within tens of metres
constexpr std::array<int, 5> kAll{0, 1, 2, 3, 4};
}  // namespace

SiteGradient::SiteGradient() {
  for (const char* name : kGradientComponents) {
    coefficients_.push_back({.name = name, .unit = "nT/m", .typical = kTypical_nT_per_m});
  }
}

std::span<const int> SiteGradient::at(int) const { return kAll; }

}  // namespace mgtd::calib::effects::laws
