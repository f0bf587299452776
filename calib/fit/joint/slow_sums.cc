// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/slow_sums.h"

#include <algorithm>

#include "calib/fit/joint/followed_pose.h"
#include "calib/linear/cholesky.h"

namespace mgtd::calib::fit::joint {

SlowEquations slow_equations(const JointProblem& problem, const JointState& state,
                             const WanderingTerms& terms) {
  const Eigen::Index channels = problem.channels(), m = channels * kWanderingTerms;
  const SlowEquations nothing{.by_fixed = Eigen::MatrixXd::Zero(problem.fixed(), m),
                              .gram = Eigen::MatrixXd::Zero(m, m),
                              .by_residual = Eigen::VectorXd::Zero(m)};
  const auto add = [&](const JointPose& pose, const FollowedPose& f, SlowEquations& out) {
    const auto w = pose.weight.asDiagonal();
    const sensor::ChannelCovariance M = w * f.readings * w;
    const Eigen::MatrixXd X = f.by_fixed * w;
    const Channels r = w * f.residual;
    const auto at = terms.at(pose.t_h);
    for (int c = 0; c < channels; ++c) {
      out.by_fixed.middleCols<kWanderingTerms>(c * kWanderingTerms) += X.col(c) * at.transpose();
      out.by_residual.segment<kWanderingTerms>(c * kWanderingTerms) += r[c] * at;
      for (int d = 0; d <= c; ++d)
        out.gram.block<kWanderingTerms, kWanderingTerms>(c * kWanderingTerms, d * kWanderingTerms) +=
            M(c, d) * at * at.transpose();
    }
  };
  SlowEquations out = sum_over_followed(problem, state, nothing, add);
  out.gram.triangularView<Eigen::StrictlyUpper>() = out.gram.transpose();
  return out;
}

SlowSums SlowSums::without(const Eigen::MatrixXd& by_columns, const Eigen::VectorXd& r) const {
  return {.gram = gram - by_columns.transpose() * by_columns,
          .by_residual = by_residual - by_columns.transpose() * r,
          .chi2 = chi2 - r.squaredNorm(),
          .dof = dof - static_cast<double>(r.size())};
}

SlowSums SlowSums::thinned(double per_effective) const {
  if (per_effective == 1) return *this;
  return {.gram = gram / per_effective,
          .by_residual = by_residual / per_effective,
          .chi2 = chi2 / per_effective,
          .dof = dof / per_effective};
}

WanderingTerms wandering_terms(const JointProblem& problem, SlowSpectrum spectrum) {
  const auto [first, last] =
      std::minmax_element(problem.poses.begin(), problem.poses.end(),
                          [](const JointPose& a, const JointPose& b) { return a.t_h < b.t_h; });
  return {first->t_h, last->t_h, spectrum, problem.poses.size()};
}

SlowSums slow_sums(const JointFit& fit, SlowSpectrum spectrum) {
  const WanderingTerms terms = wandering_terms(fit.problem, spectrum);
  if (!terms.any()) return {};
  const Reduced all = reduce(fit.problem, fit.state, 0);
  const SlowEquations slow = slow_equations(fit.problem, fit.state, terms);
  const auto information = linear::Cholesky::of(all.S);
  if (!information) return {};
  const Eigen::MatrixXd X = information->whiten(slow.by_fixed);
  const Eigen::VectorXd y = information->whiten(all.g);
  return {.gram = slow.gram - X.transpose() * X,
          .by_residual = slow.by_residual - X.transpose() * y,
          .chi2 = all.cost.total() - y.squaredNorm(),
          .dof = fit.dof + fit.dof_table};
}

}  // namespace mgtd::calib::fit::joint
