// SPDX-License-Identifier: Apache-2.0
#include "calib/design/model_on_poses.h"

#include <algorithm>

#include "calib/criticism/tests/rows.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/pose_model.h"

namespace mgtd::calib::design {
namespace {

/// What the fit left out stays out, and a pose that weighed less weighs less.
void weight_as_fitted(fit::joint::JointProblem& problem, const fit::joint::JointFit& fit) {
  const std::size_t fitted = std::min(fit.problem.poses.size(), problem.poses.size());
  for (std::size_t k = 0; k < fitted; ++k) {
    const fit::joint::JointPose& own = fit.problem.poses[k];
    fit::joint::JointPose& pose = problem.poses[k];
    pose.weight = own.weight * fit.noise_inflation;
    pose.f_weight = own.f_weight * fit.noise_inflation;
    pose.reference_weight = own.reference_weight * fit.noise_inflation;
    pose.attitude_weight = own.attitude_weight;
  }
}

}  // namespace

Result<ModelOnPoses> model_on_poses(const PoseTable& table, const fit::joint::JointFit& fit,
                                    const fit::joint::JointOptions& options) {
  auto problem = fit::joint::joint_problem(table, options);
  if (!problem) return tl::unexpected(problem.error());
  ModelOnPoses out{.problem = std::move(*problem), .state = {}};
  fit::joint::fix_gauge(out.problem, options);
  fit::joint::weight_by_pose(out.problem, fit.pose_noise_nT);
  for (fit::joint::JointPose& pose : out.problem.poses)
    if (pose.has_angles && fit.table_sd_rad > 0) pose.weigh_attitude(fit.table_sd_rad);
  weight_as_fitted(out.problem, fit);
  out.state = fit::joint::joint_state(out.problem, fit.state);
  if (out.state.coefficients.size() == fit.state.coefficients.size())
    out.state.coefficients = fit.state.coefficients;
  fit::joint::refit_nuisances(out.problem, out.state);
  return out;
}

PoseTable with_predictions(const PoseTable& run, const fit::joint::JointFit& fit) {
  PoseTable out = run;
  const fit::joint::PoseModel model(fit.problem, fit.state);
  fit::joint::PoseLinear predicted;
  std::size_t k = 0;
  for (Pose& pose : out.poses) {
    if (pose.set == "check" || k == fit.problem.poses.size()) continue;
    const fit::joint::JointPose& fitted = fit.problem.poses[k];
    model.linearise(fitted, fit.state.nuisances[k++], predicted, fit::joint::Derivatives::own);
    for (Eigen::Index c = 0; c < fitted.weight.size(); ++c)
      if (fitted.weight[c] == 0) pose.y_nT[static_cast<std::size_t>(c / 3)][c % 3] = predicted.y_nT[c];
    if (pose.f_nT && fitted.f_weight == 0) pose.f_nT = predicted.f_nT;
  }
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
