// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/axis_settling.h"

namespace mgtd::calib {

Result<Settling> Settling::on_run(const EffectContext& context) const {
  const auto run = run_memory(context);
  if (!run) return tl::unexpected(run.error());
  std::unordered_map<int, SensorReadings> v_nT;
  for (std::size_t k = 1; k < run->size(); ++k) v_nT[(*run)[k].pose] = (*run)[k - 1].v_nT;
  Settling out = *this;
  out.before = std::make_shared<const std::unordered_map<int, SensorReadings>>(std::move(v_nT));
  return out;
}

std::optional<double> Settling::previous(const Conditions& at, int sensor, int axis) const {
  const auto s = static_cast<std::size_t>(sensor);
  if (before) {
    const auto found = before->find(at.pose.number);
    if (found != before->end()) return found->second[s][axis] / kReferenceField_nT;
    return std::nullopt;
  }
  if (at.previous == nullptr) return std::nullopt;
  return at.previous->y_nT[s][axis] / kReferenceField_nT;
}

}  // namespace mgtd::calib
