// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/axis_hysteresis.h"

namespace mgtd::calib {

std::unordered_map<int, PlayState> play_before(const std::vector<RememberedPose>& run, double w) {
  std::unordered_map<int, PlayState> out;
  PlayState p;
  p.fill(Eigen::Vector3d::Zero());
  const auto move = [&](const SensorReadings& v_nT) {
    for (std::size_t i = 0; i < kSensors; ++i) {
      for (int a = 0; a < 3; ++a) p[i][a] = play(p[i][a], v_nT[i][a] / kReferenceField_nT, w);
    }
  };
  for (const RememberedPose& pose : run) {
    for (const SensorReadings& v_nT : pose.on_the_way) move(v_nT);
    out[pose.pose] = p;
    move(pose.v_nT);
  }
  return out;
}

Result<Hysteresis> Hysteresis::on_run(const EffectContext& context) const {
  const auto run = run_memory(context);
  if (!run) return tl::unexpected(run.error());
  Hysteresis out = *this;
  out.before = std::make_shared<const std::unordered_map<int, PlayState>>(
      play_before(*run, w.value_or(kDefaultWidth)));
  return out;
}

}  // namespace mgtd::calib
