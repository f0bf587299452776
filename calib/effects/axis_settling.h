// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <memory>
#include <optional>
#include <unordered_map>

#include "calib/effects/axis_nonlinearity.h"
#include "calib/effects/run_memory.h"

/// `axis.settling`: a reading creeps to its value after the table has stopped.
///
///     y += eta (x_prev - x) exp(-s/tau)       x = v/F0, eta in nT, s = seconds from the stop to mid-dwell
///
/// Needs since_stop_s. The first pose of a run has no pose before it and no term.
namespace mgtd::calib {

struct Settling {
  static constexpr std::string_view kName = "axis.settling";
  static constexpr int kPerAxis = 1;
  static constexpr double kDefaultTau_s = 10;
  std::optional<double> tau_s;
  std::shared_ptr<const std::unordered_map<int, SensorReadings>> before{};  ///< v of the pose before

  static AxisCoefficients coefficients() { return one_per_axis("nT", 2); }
  static std::string_view missing(const Pose& pose, int) { return pose.since_stop_s ? "" : "since_stop_s"; }
  void parameters(EffectSpec& spec) const {
    if (tau_s) spec.set("tau", *tau_s);
  }
  [[nodiscard]] Result<Settling> on_run(const EffectContext& context) const;
  /// x of the pose before; empty for the first.
  [[nodiscard]] std::optional<double> previous(const Conditions& at, int sensor, int axis) const;

  template <class S>
  S shape(const Conditions& at, int sensor, int axis, std::span<const S> v, int) const {
    const auto x_prev = previous(at, sensor, axis);
    if (!x_prev) return S(0.0);
    return (S(*x_prev) - in_F0(v, axis)) *
           S(std::exp(-*at.pose.since_stop_s / tau_s.value_or(kDefaultTau_s)));
  }
};

}  // namespace mgtd::calib
