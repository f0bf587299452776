// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/run_values.h"

#include <limits>

#include "calib/effects/formula/history_name.h"
#include "calib/effects/laws/run_memory.h"

namespace mgtd::calib::effects::formula {
namespace {

using Source = FormulaName::Source;

}  // namespace

Result<RunValues> RunValues::of(const EffectContext& context) {
  const auto memory = laws::run_memory(context);
  if (!memory) return tl::unexpected(memory.error());
  const poses::RunTime time = poses::RunTime::of(*context.table);
  std::vector<double> t_h;
  for (const Pose& pose : context.table->poses) t_h.push_back(time.hours(pose));
  std::vector<PerSensor<Eigen::Vector3d>> v_nT;
  v_nT.reserve((*memory)->poses.size());
  for (const laws::RememberedPose& pose : (*memory)->poses) v_nT.push_back(pose.v_nT);
  return RunValues(*context.table, std::move(t_h), std::move(v_nT));
}

std::vector<double> RunValues::of(const FormulaName& name, int sensor, int axis) const {
  if (name.source == Source::history) {
    const auto looks_back = history_name(name.name);
    return history(*looks_back, t_h_, of(looks_back->of, sensor, axis));
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto s = static_cast<std::size_t>(sensor);
  std::vector<double> out;
  for (std::size_t k = 0; k < table_->poses.size(); ++k) {
    const Pose& pose = table_->poses[k];
    switch (name.source) {
      case Source::hours:
        out.push_back(t_h_[k]);
        break;
      case Source::temperature:
        out.push_back(s < pose.T_degC.size() ? pose.T_degC[s].value_or(kNone) : kNone);
        break;
      case Source::own:
        out.push_back(v_nT_[k][s][axis]);
        break;
      case Source::input:
        out.push_back(v_nT_[k][s][static_cast<Eigen::Index>(name.index)]);
        break;
      case Source::column:
        out.push_back(name.get(pose).value_or(kNone));
        break;
      default:
        out.push_back(kNone);
    }
  }
  return out;
}

std::vector<double> RunValues::of(const std::string& name, int sensor, int axis) const {
  return of(formula_name(name, Level::axis, std::nullopt, 0), sensor, axis);
}

}  // namespace mgtd::calib::effects::formula
