// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/axis_effect.h"
#include "proto/units.h"

/// `axis.orthogonality.temperature`: the angles between the axes of a sensor move with its temperature.
///
///     y_a += sum_(b != a) chi_ab (T - T0) v_b      arcsec/degC, six a sensor: "s3.zx" is chi_zx
///
/// Axes never share a coefficient; at `all` the four sensors share six.
namespace mgtd::calib {

struct OrthogonalityTemperature {
  static constexpr std::string_view kName = "axis.orthogonality.temperature";
  static constexpr int kPerAxis = 2;
  static AxisCoefficients coefficients() {
    return {.suffix = {{{"y", "z"}, {"x", "z"}, {"x", "y"}}},
            .unit = "arcsec/degC",
            .typical = 1,
            .axes_alike = false};
  }
  static std::string_view missing(const Pose& pose, int sensor) { return missing_temperature(pose, sensor); }
  static void parameters(EffectSpec&) {}
  template <class S>
  static S shape(const Conditions& at, int sensor, int axis, std::span<const S> v, int j) {
    const int other = j < axis ? j : j + 1;
    return v[static_cast<std::size_t>(other)] * S(to_rad(1.0 / 3600) * warmer_degC(at, sensor));
  }
};

}  // namespace mgtd::calib
