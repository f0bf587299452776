// SPDX-License-Identifier: Apache-2.0
#include "calib/design/model_on_poses.h"

#include "calib/criticism/tests/rows.h"
#include "calib/effects/library/library.h"

namespace mgtd::calib::design {

Result<ModelOnPoses> model_on_poses(const PoseTable& table, const fit::joint::JointFit& fit,
                                    const fit::joint::JointOptions& options) {
  auto problem = fit::joint::joint_problem(table, options);
  if (!problem) return tl::unexpected(problem.error());
  ModelOnPoses out{.problem = std::move(*problem), .state = {}};
  fit::joint::fix_gauge(out.problem, options);
  fit::joint::weight_by_pose(out.problem, fit.pose_noise_nT);
  for (fit::joint::JointPose& pose : out.problem.poses)
    if (pose.has_angles && fit.table_sd_rad > 0) pose.weigh_attitude(fit.table_sd_rad);
  out.state = fit::joint::joint_state(out.problem, fit.state);
  if (out.state.coefficients.size() == fit.state.coefficients.size())
    out.state.coefficients = fit.state.coefficients;
  fit::joint::refit_nuisances(out.problem, out.state);
  return out;
}

Result<Eigen::MatrixXd> rows_of(const ModelOnPoses& model, const PoseTable& table,
                                const std::vector<std::string>& specs) {
  PerSensor<Eigen::Vector3d> offset_nT(model.state.sensors.size());
  for (std::size_t i = 0; i < offset_nT.size(); ++i) offset_nT[i] = model.state.sensors[i].offset_nT;
  const effects::EffectContext context{.table = &table, .offset_nT = offset_nT};
  Eigen::MatrixXd out;
  for (const std::string& text : specs) {
    const auto spec = effects::EffectSpec::parse(text);
    if (!spec) return tl::unexpected(spec.error());
    const auto effect = effects::library::make_effect(*spec, context);
    if (!effect) return tl::unexpected(effect.error());
    if (const auto ok = (*effect)->applicable(table); !ok) return tl::unexpected(ok.error());
    const Eigen::MatrixXd rows = criticism::tests::effect_rows(model.problem, model.state, *effect);
    const Eigen::Index before = out.cols();
    out.conservativeResize(rows.rows(), before + rows.cols());
    out.rightCols(rows.cols()) = rows;
  }
  return out;
}

}  // namespace mgtd::calib::design
