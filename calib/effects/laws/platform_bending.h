// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "calib/effects/laws/axis_effect.h"
#include "calib/effects/laws/platform_effect.h"
#include "proto/units.h"

/// These effects turn a sensor against the platform: R_i <- exp[omega_i]x R_i, so the sensor sees
/// exp[-omega_i]x b_i.
///
///     platform.flexure          omega_i = S_i g, g unit gravity, platform frame     deg, 3 x 3 a sensor
///     platform.thermal-bending  omega_i = w_i (T_i - T0)                            arcsec/degC, 3 a sensor
///
/// A turn that all sensors make together is a turn of the table: only its angles speak against it. One
/// such turn nothing speaks against: S_i = 1 for all turns the array about the vertical, which is another
/// declination of the field. A prior of 0.1 deg on each element of S holds it.
namespace mgtd::calib::effects::laws {

/// exp[-omega]x b - b, exact for any omega and smooth at zero.
template <class S>
void turn_term(const std::array<S, 3>& w, std::span<const S> b, std::span<S> out) {
  using std::cos, std::sin, std::sqrt;
  const S t = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
  S first(1.0), second(0.5);         // sin|w|/|w| and (1 - cos|w|)/|w|^2
  if (sensor::value_of(t) < 0.01) {  // series to 1e-16
    first = S(1.0) - t * (S(1.0 / 6) - t * (S(1.0 / 120) - t * (S(1.0 / 5040) - t * S(1.0 / 362880))));
    second = S(0.5) - t * (S(1.0 / 24) - t * (S(1.0 / 720) - t * (S(1.0 / 40320) - t * S(1.0 / 3628800))));
  } else {
    const S angle = sqrt(t);
    first = sin(angle) / angle;
    second = (S(1.0) - cos(angle)) / t;
  }
  const std::array<S, 3> wb{w[1] * b[2] - w[2] * b[1], w[2] * b[0] - w[0] * b[2], w[0] * b[1] - w[1] * b[0]};
  out[0] = second * (w[1] * wb[2] - w[2] * wb[1]) - first * wb[0];
  out[1] = second * (w[2] * wb[0] - w[0] * wb[2]) - first * wb[1];
  out[2] = second * (w[0] * wb[1] - w[1] * wb[0]) - first * wb[2];
}

class Flexure final : public PlatformEffect<Flexure> {
 public:
  static constexpr std::string_view kName = "platform.flexure";
  explicit Flexure(const Where& where);
  [[nodiscard]] std::string_view missing(const Pose& pose) const override { return missing_angle(pose); }

  template <class S>
  void equation(const Conditions&, int, std::span<const S> in, std::span<const S> c, std::span<S> out) const {
    if (c.empty()) {
      out[0] = out[1] = out[2] = S(0.0);
      return;
    }
    std::array<S, 3> w;
    for (std::size_t i = 0; i < 3; ++i)
      w[i] = (c[3 * i] * in[3] + c[3 * i + 1] * in[4] + c[3 * i + 2] * in[5]) * S(to_rad(1.0));
    turn_term(w, in.first(3), out);
  }
};

class ThermalBending final : public PlatformEffect<ThermalBending> {
 public:
  static constexpr std::string_view kName = "platform.thermal-bending";
  explicit ThermalBending(const Where& where);
  [[nodiscard]] std::string_view missing(const Pose& pose) const override;

  template <class S>
  void equation(const Conditions& at, int sensor, std::span<const S> in, std::span<const S> c,
                std::span<S> out) const {
    if (c.empty()) {
      out[0] = out[1] = out[2] = S(0.0);
      return;
    }
    const S warmer(to_rad(warmer_degC(at, sensor) / 3600));
    turn_term<S>({c[0] * warmer, c[1] * warmer, c[2] * warmer}, in.first(3), out);
  }
};

}  // namespace mgtd::calib::effects::laws
