// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/model_stage.h"

#include <fmt/format.h>

#include <cmath>

#include "calib/fit/joint/joint_report.h"

namespace mgtd::calib::criticism::search {
namespace {

/// The poses of `to`, the same as those of `from`, take over what their observations weigh.
void weigh_alike(const fit::joint::JointProblem& from, fit::joint::JointProblem& to) {
  for (std::size_t k = 0; k < to.poses.size(); ++k) {
    to.poses[k].weight = from.poses[k].weight;
    to.poses[k].attitude_weight = from.poses[k].attitude_weight;
    to.poses[k].f_weight = from.poses[k].f_weight;
    to.poses[k].reference_weight = from.poses[k].reference_weight;
  }
}

}  // namespace

Result<ModelStage> model_stage(const PoseTable& table, const fit::FitOptions& options) {
  auto joint = fit::joint::profiled_options(table, options);
  if (!joint) return tl::unexpected(joint.error());
  auto fit = fit::joint::fit_joint(table, *joint);
  if (!fit) return tl::unexpected(fit.error());
  ModelStage out{.options = *std::move(joint), .fit = std::move(*fit), .errors = {}};
  out.errors = fit::joint::joint_errors(out.fit.problem, out.fit.state, fit::joint::FixedBlock::fitted);
  out.held_out = fit::joint::held_out_errors(out.fit, fit::joint::reduce(out.fit.problem, out.fit.state, 0));
  return out;
}

Result<fit::joint::JointFit> fit_under_same_weights(const PoseTable& table, const ModelStage& stage,
                                                    const std::vector<effects::EffectPtr>& effects) {
  fit::joint::JointOptions options = stage.options;
  options.effects = effects;
  auto problem = fit::joint::joint_problem(table, options);
  if (!problem) return tl::unexpected(problem.error());
  fit::joint::fix_gauge(*problem, options);
  weigh_alike(stage.fit.problem, *problem);
  fit::joint::JointState start = fit::joint::joint_state(*problem, stage.fit.state);
  auto solved = fit::joint::solve(*problem, std::move(start));
  if (!solved) return tl::unexpected(solved.error());
  fit::joint::JointFit out = stage.fit;
  out.problem = std::move(*problem);
  out.state = std::move(solved->state);
  out.chi2 = solved->reduced.cost.of_model();
  auto covariance = fit::joint::covariance_of(out, solved->reduced);
  if (!covariance) return tl::unexpected(covariance.error());
  out.covariance = *std::move(covariance);
  return out;
}

VariancePrice variance_price(const fit::joint::JointFit& narrow, const fit::joint::JointFit& wide) {
  VariancePrice out;
  fit::joint::JointProblem same = narrow.problem;
  weigh_alike(wide.problem, same);
  const auto before = fit::joint::covariance_of(fit::joint::reduce(same, narrow.state, 0).S);
  const auto after = fit::joint::covariance_of(fit::joint::reduce(wide.problem, wide.state, 0).S);
  if (!before || !after) return out;
  for (int i = 0; i < wide.problem.slots().sensor_block(); ++i) {
    const double sd_ratio = std::sqrt((*after)(i, i) / (*before)(i, i));
    if (!std::isfinite(sd_ratio) || sd_ratio <= out.sd_ratio) continue;
    out.sd_ratio = sd_ratio;
    out.parameter =
        fmt::format("s{}.{}", i / sensor::kSensorParameters + 1,
                    sensor::kParameterNames[static_cast<std::size_t>(i % sensor::kSensorParameters)]);
  }
  return out;
}

}  // namespace mgtd::calib::criticism::search
