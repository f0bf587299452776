// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/laws/axis_effect.h"
#include "proto/units.h"

/// These effects move the angles between the axes of a sensor with its temperature.
///
///     axis.orthogonality.temperature    y_a += sum_(b != a) chi_ab (T - T0) v_b       arcsec/degC
///     axis.orthogonality.temperature2   y_a += sum_(b != a) chi2_ab (T - T0)^2 v_b    arcsec/degC^2
///
/// Six a sensor each: "s3.zx" is chi_zx.
/// Axes never share a coefficient; at `all` the four sensors share six.
namespace mgtd::calib::effects::laws {

template <int kPower>
struct OrthogonalityLaw : TemperatureLaw {
  static constexpr std::string_view kName =
      kPower == 1 ? "axis.orthogonality.temperature" : "axis.orthogonality.temperature2";
  static constexpr int kPerAxis = 2;
  static AxisCoefficients coefficients() {
    return {.suffix = {{{"y", "z"}, {"x", "z"}, {"x", "y"}}},
            .unit = kPower == 1 ? "arcsec/degC" : "arcsec/degC^2",
            .typical = kPower == 1 ? 1 : 0.1,
            .axes_alike = false};
  }
  template <class S>
  static S shape(const Conditions& at, int sensor, int axis, std::span<const S> v, int j) {
    const int other = j < axis ? j : j + 1;
    const double warmer = warmer_degC(at, sensor);
    return v[static_cast<std::size_t>(other)] *
           S(to_rad(1.0 / 3600) * (kPower == 1 ? warmer : warmer * warmer));
  }
};
using OrthogonalityTemperature = OrthogonalityLaw<1>;
using OrthogonalityTemperature2 = OrthogonalityLaw<2>;

}  // namespace mgtd::calib::effects::laws
