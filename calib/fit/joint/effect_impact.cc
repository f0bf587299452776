// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/effect_impact.h"

#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/tensor_uncertainty.h"
#include "calib/linear/cholesky.h"

namespace mgtd::calib::fit::joint {
namespace {

/// The fit's problem with an effect more.
JointProblem with_effect(const JointProblem& problem, const effects::EffectPtr& effect, Eigen::Index added) {
  JointProblem out = problem;
  out.effects.push_back(effect);
  for (LinearPrior& prior : out.priors) {
    const Eigen::Index known = prior.row.size();
    prior.row.conservativeResize(known + added);
    prior.row.tail(added).setZero();
  }
  return out;
}

}  // namespace

Result<EffectImpact> effect_impact(const JointFit& fit, const effects::EffectPtr& effect,
                                   const Eigen::VectorXd& coefficients) {
  const Eigen::Index added = coefficients.size(), before = fit.problem.fixed();
  const JointProblem wider = with_effect(fit.problem, effect, added);
  JointState state = fit.state;
  state.coefficients.conservativeResize(fit.state.coefficients.size() + added);
  state.coefficients.tail(added).setZero();
  const Eigen::MatrixXd S = reduce(wider, state, 0).S;
  const auto information = linear::Cholesky::of(S.topLeftCorner(before, before));
  if (!information) return tl::unexpected(information.error());
  const Eigen::VectorXd step =
      information->solve(Eigen::VectorXd(S.topRightCorner(before, added) * coefficients));
  const TensorResponse response(fit.state.sensors, fit.problem.geometry, mean_field(fit));
  const WorstComponent worst = worst_component(response.shift(step));
  return EffectImpact{worst.value, worst.name};
}

}  // namespace mgtd::calib::fit::joint
