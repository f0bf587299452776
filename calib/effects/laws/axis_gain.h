// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <optional>

#include "calib/effects/laws/axis_effect.h"

/// These effects change the scale factor of an axis:
///
///     axis.gain.temperature    y += 1e-6 kappa (T - T0) v       ppm/degC
///     axis.gain.temperature2   y += 1e-6 kappa2 (T - T0)^2 v    ppm/degC^2
///     axis.gain.drift          y += 1e-6 g (t - t0) v           ppm/h
///     axis.gain.step           y += 1e-6 g v [|v| > c]          ppm, c in nT
namespace mgtd::calib::effects::laws {

struct GainTemperature : TemperatureLaw {
  static constexpr std::string_view kName = "axis.gain.temperature";
  static AxisCoefficients coefficients() { return one_per_axis("ppm/degC", 20); }
  template <class S>
  static S shape(const Conditions& at, int sensor, int axis, std::span<const S> v, int) {
    return v[static_cast<std::size_t>(axis)] * S(1e-6 * warmer_degC(at, sensor));
  }
};

struct GainTemperature2 : TemperatureLaw {
  static constexpr std::string_view kName = "axis.gain.temperature2";
  static AxisCoefficients coefficients() { return one_per_axis("ppm/degC^2", 1); }
  template <class S>
  static S shape(const Conditions& at, int sensor, int axis, std::span<const S> v, int) {
    return v[static_cast<std::size_t>(axis)] * S(1e-6 * warmer_degC(at, sensor) * warmer_degC(at, sensor));
  }
};

struct GainDrift : TimeLaw {
  static constexpr std::string_view kName = "axis.gain.drift";
  static AxisCoefficients coefficients() { return one_per_axis("ppm/h", 5); }
  template <class S>
  static S shape(const Conditions& at, int, int axis, std::span<const S> v, int) {
    return v[static_cast<std::size_t>(axis)] * S(1e-6 * at.t_h);
  }
};

struct GainStep {
  static constexpr std::string_view kName = "axis.gain.step";
  static constexpr int kPerAxis = 1;
  static constexpr double kDefault_nT = 25'000;
  std::optional<double> c_nT;
  static AxisCoefficients coefficients() { return one_per_axis("ppm", 50); }
  static std::string_view missing(const Pose&, int) { return {}; }
  void parameters(EffectSpec& spec) const {
    if (c_nT) spec.set("c", *c_nT);
  }
  template <class S>
  S shape(const Conditions&, int, int axis, std::span<const S> v, int) const {
    const S& own = v[static_cast<std::size_t>(axis)];
    return own * S(std::abs(sensor::value_of(own)) > c_nT.value_or(kDefault_nT) ? 1e-6 : 0.0);
  }
};

}  // namespace mgtd::calib::effects::laws
