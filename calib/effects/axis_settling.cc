// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/axis_settling.h"

namespace mgtd::calib {

void LiveSettling::begin(double t_s, const SensorReadings& v_nT) {
  since_s_ = t_s;
  z_nT_ = v_nT;
}

void LiveSettling::step(double dt_s, const SensorReadings& v_nT) {
  const double left = std::exp(-dt_s / tau_s_);
  for (std::size_t i = 0; i < kSensors; ++i) z_nT_[i] = v_nT[i] + left * (z_nT_[i] - v_nT[i]);
}

std::pair<Settling, std::shared_ptr<LiveMemory>> Settling::live() const {
  auto memory = std::make_shared<LiveSettling>(tau_s.value_or(kDefaultTau_s));
  return {Settling{tau_s, nullptr, memory}, memory};
}

Result<Settling> Settling::on_run(const EffectContext& context) const {
  const auto run = run_memory(context);
  if (!run) return tl::unexpected(run.error());
  std::unordered_map<int, std::optional<SensorReadings>> v_nT;
  std::optional<SensorReadings> last;
  for (const RememberedPose& pose : *run) {
    v_nT[pose.pose] = last;
    last = pose.v_nT;
  }
  Settling out = *this;
  out.before = std::make_shared<const decltype(v_nT)>(std::move(v_nT));
  return out;
}

}  // namespace mgtd::calib
