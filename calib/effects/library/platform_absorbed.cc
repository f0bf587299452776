// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/library/platform_absorbed.h"

#include <fmt/format.h>

#include "calib/effects/library/effect_family.h"
#include "calib/sensor/geometry.h"

namespace mgtd::calib::effects::library {

Result<void> absorbed(std::string_view name) {
  const EffectFamily* family = find_family(name);
  return fail(ErrorCode::refused, fmt::format("{}: {}", name, family->untestable),
              std::string(family->experiment));
}

Crosstalk::Crosstalk(double baseline_m) : baseline_m_(baseline_m) {
  constexpr double kCubicCentimetre_m3 = 1e-6;
  const auto r = sensor::Geometry(baseline_m).positions_P_m();
  for (std::size_t i = 0; i < kSensors; ++i) {
    coefficients_.push_back({.name = sensor_name(static_cast<int>(i)), .unit = "cm^3", .typical = 3});
    for (std::size_t j = 0; j < kSensors; ++j) {
      coupling_[i][j].setZero();
      if (i == j) continue;
      const Eigen::Vector3d d = r[i] - r[j], n = d.normalized();
      coupling_[i][j] =
          kCubicCentimetre_m3 / std::pow(d.norm(), 3) * (3 * n * n.transpose() - Eigen::Matrix3d::Identity());
    }
  }
}

std::string Crosstalk::spec() const { return fmt::format("{},baseline={}", name(), baseline_m_); }

}  // namespace mgtd::calib::effects::library
