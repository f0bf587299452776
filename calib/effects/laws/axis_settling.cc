// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/axis_settling.h"

#include <algorithm>
#include <cmath>

namespace mgtd::calib::effects::laws {

void LiveSettling::begin(double t_s, const SensorReadings& v_nT) {
  since_s_ = t_s;
  z_nT_ = v_nT;
}

void LiveSettling::step(double dt_s, const SensorReadings& v_nT) {
  const double left = std::exp(-dt_s / tau_s_);
  for (std::size_t i = 0; i < z_nT_.size(); ++i) z_nT_[i] = v_nT[i] + left * (z_nT_[i] - v_nT[i]);
}

std::pair<Settling, std::shared_ptr<LiveMemory>> Settling::live() const {
  auto memory = std::make_shared<LiveSettling>(tau_s.value_or(kDefaultTau_s));
  return {Settling{tau_s, nullptr, memory}, memory};
}

namespace {

/// dz/dt = (v - z)/tau.
class Slow {
 public:
  Slow(double tau_s, double t_s, const SensorReadings& v_nT)
      : tau_s_(tau_s), t_s_(t_s), v_nT_(v_nT), z_nT_(v_nT) {}

  /// v runs straight to `v_nT` until then; exact.
  void follow(double t_s, const SensorReadings& v_nT) {
    const double dt_s = t_s - t_s_;
    if (!(dt_s > 0)) return;
    const double left = std::exp(-dt_s / tau_s_);
    for (std::size_t i = 0; i < z_nT_.size(); ++i) {
      const Eigen::Vector3d lag_nT = (v_nT[i] - v_nT_[i]) * (tau_s_ / dt_s);
      z_nT_[i] = v_nT[i] - lag_nT + left * (z_nT_[i] - v_nT_[i] + lag_nT);
    }
    t_s_ = t_s;
    v_nT_ = v_nT;
  }
  void rest(double until_s) { follow(until_s, v_nT_); }
  [[nodiscard]] const SensorReadings& z_nT() const { return z_nT_; }

 private:
  double tau_s_, t_s_;
  SensorReadings v_nT_, z_nT_;
};

/// Mean of exp(-s/tau) over D seconds against exp(-s/tau) in their middle.
double over_dwell(double D_s, double tau_s) {
  const double half = D_s / (2 * tau_s);
  return half > 1e-6 ? std::sinh(half) / half : 1;
}

/// The slow readings at the stops of a run.
class Stops {
 public:
  explicit Stops(double tau_s) : tau_s_(tau_s) {}

  [[nodiscard]] std::optional<SlowAtStop> at(const Pose& pose, const RememberedPose& remembered) {
    const std::optional<SlowAtStop> out = begins_with(pose, remembered);
    if (!slow_ && pose.t_s) slow_.emplace(tau_s_, *pose.t_s, remembered.v_nT);
    if (slow_ && pose.t_s) slow_->follow(*pose.t_s, remembered.v_nT);
    before_nT_ = remembered.v_nT;
    return out;
  }

 private:
  [[nodiscard]] std::optional<SlowAtStop> begins_with(const Pose& pose, const RememberedPose& remembered) {
    if (!before_nT_) return std::nullopt;
    if (!slow_ || remembered.on_the_way.empty() || !pose.t_s || !pose.since_stop_s)
      return SlowAtStop{*before_nT_};
    const double stop_s = *pose.t_s - *pose.since_stop_s;
    slow_->rest(std::min(stop_s, remembered.on_the_way.front().t_s));
    for (const RememberedWayPoint& point : remembered.on_the_way) {
      if (point.t_s > stop_s) break;
      slow_->follow(point.t_s, point.v_nT);
    }
    slow_->follow(stop_s, remembered.v_nT);
    return SlowAtStop{slow_->z_nT(), over_dwell(pose.dwell_s.value_or(0), tau_s_)};
  }

  double tau_s_;
  std::optional<Slow> slow_{};
  std::optional<SensorReadings> before_nT_{};
};

}  // namespace

Result<Settling> Settling::on_run(const EffectContext& context) const {
  const auto run = run_memory(context);
  if (!run) return tl::unexpected(run.error());
  std::unordered_map<int, std::optional<SlowAtStop>> at_stop;
  Stops stops(tau_s.value_or(kDefaultTau_s));
  const std::vector<RememberedPose>& poses = (*run)->poses;
  for (std::size_t k = 0; k < poses.size(); ++k)
    at_stop[poses[k].pose] = stops.at(context.table->poses[k], poses[k]);
  Settling out = *this;
  out.before = std::make_shared<const decltype(at_stop)>(std::move(at_stop));
  return out;
}

}  // namespace mgtd::calib::effects::laws
