// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/agreement.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/fit/joint/without_poses.h"
#include "calib/linear/cholesky.h"
#include "calib/stats/median.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::fit::joint {
namespace {

/// In variance, of what the noise of the pose does on average: below, it is the design and not the reading.
constexpr double kByNoise = 16;

/// With S and g of all poses and S_k, g_k of one, the fit without it moves by (S - S_k)^-1 (g - g_k).
///
/// With A the whitened rows of the pose by the fixed block, its own unknowns projected out, e its residual
/// and H = A S^-1 A', that is e' H (I - H)^-1 e in variance, and noise does trace H (I - H)^-1 of it. The
/// first is at most e'e times the second, and e'e at most what the pose costs: one that costs little has no
/// influence worth saying and need not be asked.
void influence_of_poses(const JointFit& fit, const Eigen::MatrixXd& S, Agreement& out) {
  constexpr double kRounding = 0.99;
  const double scale = fit.noise_inflation / fit.birge_ratio;
  JointProblem alone = without_poses_and_priors(fit.problem);
  alone.poses.resize(1);
  JointState at = without_poses(fit.state);
  at.nuisances.resize(1);
  const PoseModel model(fit.problem, fit.state);
  PoseBlocks b;
  for (std::size_t k = 0; k < fit.problem.poses.size(); ++k) {
    assemble(fit.problem, model, fit.state, k, Blocks::own, b);
    if (b.cost.total() * scale * scale < kRounding * kByNoise) continue;
    alone.poses.front() = fit.problem.poses[k];
    at.nuisances.front() = fit.state.nuisances[k];
    const Reduced own = reduce(alone, at, 0);
    Eigen::MatrixXd others = S - own.S;
    for (Eigen::Index i = 0; i < S.rows(); ++i)
      if (S(i, i) == 1 && own.S(i, i) == 1) others(i, i) = 1;  // held slots stay held
    const auto information = linear::Cholesky::of(others);
    if (!information) continue;
    const double moved = information->squared_length(own.g * scale);
    const double by_noise = information->solve(own.S).trace();
    const double size = std::sqrt(moved / static_cast<double>(S.rows()));
    if (moved > kByNoise * by_noise && size > out.moved)
      out.moved = size, out.pose = fit.problem.poses[k].pose->number;
  }
}

}  // namespace

bool Scatter::few_far_off() const { return residual_nT > kMaxTails * typical_nT; }

Scatter scatter_of(const JointFit& fit) {
  Scatter out;
  const PoseResiduals residuals = pose_residuals(fit.problem, fit.state);
  double squares = 0, count = 0, typical = 0;
  for (int c = 0; c < fit.problem.channels(); ++c) {
    std::vector<double> misfits;
    for (std::size_t k = 0; k < fit.problem.poses.size(); ++k) {
      const auto t = static_cast<double>(residuals.t(c, static_cast<Eigen::Index>(k)));
      if (t > 0) misfits.push_back(t / fit.problem.poses[k].weight[c]);
    }
    if (misfits.empty()) continue;
    for (const double x : misfits) squares += x * x, ++count;
    typical += std::pow(stats::kMadToSd * stats::median(misfits), 2) / fit.problem.channels();
  }
  out.residual_nT = std::sqrt(squares / std::max(1.0, count));
  out.typical_nT = std::sqrt(typical);
  return out;
}

Agreement agreement(const JointFit& fit, const Eigen::MatrixXd& S, double fitted_nT,
                    std::optional<double> held_out_nT) {
  Agreement out;
  out.poses = static_cast<int>(fit.problem.poses.size());
  out.fitted_nT = fitted_nT;
  out.held_out_nT = held_out_nT;
  out.scatter = scatter_of(fit);
  influence_of_poses(fit, S, out);
  return out;
}

}  // namespace mgtd::calib::fit::joint
