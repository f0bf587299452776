// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/effects/laws/axis_effect.h"
#include "calib/poses/run_time.h"

/// These effects change the offset of an axis, by an amount that does not depend on the field:
///
///     axis.offset.temperature    y += alpha (T - T0)         nT/degC
///     axis.offset.temperature2   y += alpha2 (T - T0)^2      nT/degC^2
///     axis.offset.drift          y += delta (t - t0)         nT/h
///     axis.offset.step           y += s [t >= ts]            nT, ts in hours since the start of the run
namespace mgtd::calib::effects::laws {

struct OffsetTemperature : TemperatureLaw {
  static constexpr std::string_view kName = "axis.offset.temperature";
  static AxisCoefficients coefficients() { return one_per_axis("nT/degC", 0.3); }
  template <class S>
  static S shape(const Conditions& at, int sensor, int, std::span<const S>, int) {
    return S(warmer_degC(at, sensor));
  }
};

struct OffsetTemperature2 : TemperatureLaw {
  static constexpr std::string_view kName = "axis.offset.temperature2";
  static AxisCoefficients coefficients() { return one_per_axis("nT/degC^2", 0.02); }
  template <class S>
  static S shape(const Conditions& at, int sensor, int, std::span<const S>, int) {
    return S(warmer_degC(at, sensor) * warmer_degC(at, sensor));
  }
};

struct OffsetDrift : TimeLaw {
  static constexpr std::string_view kName = "axis.offset.drift";
  static AxisCoefficients coefficients() { return one_per_axis("nT/h", 1); }
  template <class S>
  static S shape(const Conditions& at, int, int, std::span<const S>, int) {
    return S(at.t_h);
  }
};

/// Hours since the start of the run, half-way through its poses.
[[nodiscard]] std::optional<double> middle_h(const EffectContext& context);

struct OffsetStep {
  static constexpr std::string_view kName = "axis.offset.step";
  static constexpr int kPerAxis = 1;
  std::optional<double> ts_h;  ///< not given: the middle of the run it is bound to
  static AxisCoefficients coefficients() { return one_per_axis("nT", 2); }
  static std::string_view missing(const Pose& pose, int) { return poses::missing_time(pose); }
  void parameters(EffectSpec& spec) const {
    if (ts_h) spec.set("ts", *ts_h);
  }
  [[nodiscard]] Result<OffsetStep> on_run(const EffectContext& context) const {
    return OffsetStep{ts_h ? ts_h : middle_h(context)};
  }
  template <class S>
  S shape(const Conditions& at, int, int, std::span<const S>, int) const {
    return S(at.t_h >= ts_h.value_or(0) ? 1.0 : 0.0);
  }
};

}  // namespace mgtd::calib::effects::laws
