// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/axis_settling.h"

namespace mgtd::calib {

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
