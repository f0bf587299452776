// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <nlohmann/json.hpp>

#include "tests/rig/effect.h"

namespace mgtd::rig {

/// These are the measured laws of four real fluxgates (sensors 687 to 690 of the AUV Sentry; as published in
/// the Matlab function Mag_calib1520_sensors of its magnetic processing): offset, scale and the three angles
/// between the axes, each a parabola of the temperature. Their size: 1 to 9 nT/degC, 7 to 600 ppm/degC, 2 to
/// 34 arcsec/degC.
///
/// raw = S(T) Q(T) B + o(T) there; here what changes from T0 = 20 degC is put on the rig's own sensors, whose
/// parameters hold at T0:
///     y += [S(T) S(T0)^-1 Q(T) Q(T0)^-1 - 1] v + o(T) - o(T0)
///     Q = [1 0 0; -sin u1 cos u1 0; sin u2 sin u3 sqrt(1 - sin^2 u2 - sin^2 u3)]
/// A fifth sensor has the law of the first again, and so on.
class TemperatureLaw final : public EffectOf<TemperatureLaw> {
 public:
  [[nodiscard]] double axis_nT(const AxisContext& c) const override;
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "temperature-law"}, {"law", "calib1520"}};
  }

 private:
  struct Change {
    double T_degC{kT0_degC};
    Eigen::Matrix3d gain{Eigen::Matrix3d::Zero()};  ///< less one
    Eigen::Vector3d offset_nT{0, 0, 0};
  };
  mutable std::array<Change, kMostPlaces> change_{};  ///< three axes ask at one temperature
};

}  // namespace mgtd::rig
