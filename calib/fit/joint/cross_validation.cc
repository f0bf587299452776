// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/cross_validation.h"

#include "calib/fit/joint/pose_residuals.h"
#include "calib/fit/joint/without_poses.h"
#include "calib/linear/cholesky.h"

namespace mgtd::calib::fit::joint {
namespace {

struct Fold {
  JointProblem problem;
  JointState state;  ///< of its own poses
  Reduced share;     ///< of the normal equations, priors not in it
};

Fold fold_of(const JointFit& fit, std::size_t k) {
  const std::size_t n = fit.problem.poses.size(), from = k * n / kFolds, to = (k + 1) * n / kFolds;
  const auto at = [](auto& x, std::size_t i) { return x.begin() + static_cast<std::ptrdiff_t>(i); };
  Fold out{.problem = without_poses_and_priors(fit.problem), .state = without_poses(fit.state), .share = {}};
  out.problem.poses.assign(at(fit.problem.poses, from), at(fit.problem.poses, to));
  out.state.nuisances.assign(at(fit.state.nuisances, from), at(fit.state.nuisances, to));
  out.share = reduce(out.problem, out.state, 0);
  return out;
}

}  // namespace

bool for_each_fold_left_out(
    const JointFit& fit, const Reduced& equations,
    const std::function<void(const JointProblem& fold, const JointState& state)>& use) {
  for (std::size_t k = 0; k < kFolds; ++k) {
    Fold fold = fold_of(fit, k);
    // Slots that nothing observes are held by a unit in both: they stay held.
    Eigen::MatrixXd S = equations.S - fold.share.S;
    for (Eigen::Index i = 0; i < S.rows(); ++i)
      if (equations.S(i, i) == 1 && fold.share.S(i, i) == 1) S(i, i) = 1;
    const auto information = linear::Cholesky::of(S);
    if (!information) return false;
    JointState moved = fold.state.moved(information->solve(Eigen::VectorXd(equations.g - fold.share.g)));
    refit_nuisances(fold.problem, moved);
    use(fold.problem, moved);
  }
  return true;
}

std::optional<double> left_out_nT(const JointFit& fit) {
  PoseResiduals sums;
  const Reduced equations = reduce(fit.problem, fit.state, 0);
  const bool all =
      for_each_fold_left_out(fit, equations, [&](const JointProblem& fold, const JointState& state) {
        const PoseResiduals more = pose_residuals(fold, state);
        sums.squares_nT2 += more.squares_nT2, sums.freedom += more.freedom, sums.readings += more.readings;
      });
  return all && sums.readings > 0 ? std::optional(sums.unseen_nT()) : std::nullopt;
}

}  // namespace mgtd::calib::fit::joint
