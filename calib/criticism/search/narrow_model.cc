// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/narrow_model.h"

#include <utility>

namespace mgtd::calib::criticism::search {

std::optional<NarrowModel> narrow_model(const PoseTable& table, const fit::joint::JointOptions& options,
                                        const fit::joint::JointFit& with) {
  auto problem = fit::joint::joint_problem(table, options);
  if (!problem || problem->poses.size() != with.problem.poses.size()) return std::nullopt;
  fit::joint::fix_gauge(*problem, options);
  for (std::size_t k = 0; k < problem->poses.size(); ++k) {
    problem->poses[k].weight = with.problem.poses[k].weight;
    problem->poses[k].f_weight = with.problem.poses[k].f_weight;
    problem->poses[k].attitude_weight = with.problem.poses[k].attitude_weight;
    problem->poses[k].reference_weight = with.problem.poses[k].reference_weight;
  }
  fit::joint::JointState state = fit::joint::joint_state(*problem, with.state);
  state.nuisances = with.state.nuisances;
  Eigen::Index at = 0;
  for (const effects::EffectPtr& effect : problem->effects) {
    const auto own = static_cast<Eigen::Index>(effect->coefficients().size());
    Eigen::Index from = 0;
    for (const effects::EffectPtr& known : with.problem.effects) {
      if (known->spec() == effect->spec())
        state.coefficients.segment(at, own) = with.state.coefficients.segment(from, own);
      from += static_cast<Eigen::Index>(known->coefficients().size());
    }
    at += own;
  }
  return NarrowModel{*std::move(problem), std::move(state)};
}

}  // namespace mgtd::calib::criticism::search
