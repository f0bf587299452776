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
  /// v of the pose before; empty for the first of the run.
  std::shared_ptr<const std::unordered_map<int, std::optional<SensorReadings>>> before{};

  static AxisCoefficients coefficients() { return one_per_axis("nT", 2); }
  [[nodiscard]] std::string_view missing(const Pose& pose, int) const {
    if (!pose.since_stop_s) return "since_stop_s";
    return before && before->contains(pose.number) ? "" : kNoMemory;
  }
  void parameters(EffectSpec& spec) const {
    if (tau_s) spec.set("tau", *tau_s);
  }
  [[nodiscard]] Result<Settling> on_run(const EffectContext& context) const;

  template <class S>
  S shape(const Conditions& at, int sensor, int axis, std::span<const S> v, int) const {
    const auto& v_prev = before->at(at.pose.number);
    if (!v_prev) return S(0.0);
    const double x_prev = (*v_prev)[static_cast<std::size_t>(sensor)][axis] / kReferenceField_nT;
    return (S(x_prev) - in_F0(v, axis)) * S(std::exp(-*at.pose.since_stop_s / tau_s.value_or(kDefaultTau_s)));
  }
};

}  // namespace mgtd::calib
