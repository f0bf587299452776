// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <memory>
#include <optional>
#include <unordered_map>

#include "calib/effects/laws/axis_nonlinearity.h"
#include "calib/effects/laws/live_memory.h"
#include "calib/effects/laws/run_memory.h"

/// `axis.settling` is the creep of a reading to its value after the table has stopped.
///
///     y += eta (x_prev - x) exp(-s/tau)       x = v/F0, eta in nT, s = seconds from the stop to mid-dwell
///
/// Needs since_stop_s. The first pose of a run has no pose before it and no term.
///
/// x_prev stands for a slow reading z that follows x with the time constant tau, dz/dt = (x - z)/tau, and
/// has come to rest at each pose; y += eta (z - x). Where the run kept the way of the table, z itself is
/// followed, straight from point to point: x_prev is z at the stop, and exp(-s/tau) its mean over the dwell.
/// On a stream z follows the samples and is known five time constants after the first.
namespace mgtd::calib::effects::laws {

/// The slow part z of the readings on a stream.
class LiveSettling final : public LiveMemory {
 public:
  explicit LiveSettling(double tau_s) : tau_s_(tau_s) {}
  [[nodiscard]] bool known() const { return begun() && last_s() - since_s_ >= kKnown * tau_s_; }
  [[nodiscard]] double slow_nT(int sensor, int axis) const {
    return z_nT_[static_cast<std::size_t>(sensor)][axis];
  }

 protected:
  void begin(double t_s, const SensorReadings& v_nT) override;
  void step(double dt_s, const SensorReadings& v_nT) override;

 private:
  static constexpr double kKnown = 5;  ///< time constants: 0.7 % of what it began with is left
  double tau_s_, since_s_{0};
  SensorReadings z_nT_;
};

/// What a pose begins with.
struct SlowAtStop {
  SensorReadings v_nT;
  double over_dwell{1};  ///< mean of exp(-s/tau) over the dwell against its middle
};

struct Settling {
  static constexpr std::string_view kName = "axis.settling";
  static constexpr int kPerAxis = 1;
  static constexpr double kDefaultTau_s = 10;
  std::optional<double> tau_s;
  /// By number of the pose; empty for the first of the run.
  std::shared_ptr<const std::unordered_map<int, std::optional<SlowAtStop>>> before{};
  std::shared_ptr<const LiveSettling> now{};  ///< on a stream

  static AxisCoefficients coefficients() { return one_per_axis("nT", 2); }
  [[nodiscard]] std::string_view missing(const Pose& pose, int) const {
    if (now) return now->known() ? "" : kNoMemory;
    if (!pose.since_stop_s) return "since_stop_s";
    return before && before->contains(pose.number) ? "" : kNoMemory;
  }
  void parameters(EffectSpec& spec) const {
    if (tau_s) spec.set("tau", *tau_s);
  }
  [[nodiscard]] Result<Settling> on_run(const EffectContext& context) const;
  [[nodiscard]] std::pair<Settling, std::shared_ptr<LiveMemory>> live() const;

  template <class S>
  S shape(const Conditions& at, int sensor, int axis, std::span<const S> v, int) const {
    if (now) return S(now->slow_nT(sensor, axis) / kReferenceField_nT) - in_F0(v, axis);
    const auto& slow = before->at(at.pose.number);
    if (!slow) return S(0.0);
    const double x_prev = slow->v_nT[static_cast<std::size_t>(sensor)][axis] / kReferenceField_nT;
    const double left = slow->over_dwell * std::exp(-*at.pose.since_stop_s / tau_s.value_or(kDefaultTau_s));
    return (S(x_prev) - in_F0(v, axis)) * S(left);
  }
};

}  // namespace mgtd::calib::effects::laws
