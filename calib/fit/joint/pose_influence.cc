// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/pose_influence.h"

#include <cmath>
#include <limits>

#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/tensor_uncertainty.h"
#include "calib/fit/joint/without_poses.h"
#include "calib/linear/cholesky.h"

namespace mgtd::calib::fit::joint {
namespace {

constexpr double kNotDetermined = std::numeric_limits<double>::quiet_NaN();

/// reduce() holds slots that no observation reaches by a unit information, which is no pose's.
void release_idle_slots(const JointProblem& problem, Eigen::MatrixXd& S) {
  for (const int slot : problem.idle_slots()) S(slot, slot) = 0;
}

/// Observations of a pose less its own nuisances.
double observations_of(const JointPose& pose) {
  return static_cast<double>((pose.weight.array() > 0).count()) + (pose.f_weight > 0 ? 1 : 0) + pose.beside();
}

}  // namespace

Result<std::vector<PoseInfluence>> pose_influences(const JointFit& fit) {
  const Reduced all = reduce(fit.problem, fit.state, 0);
  const auto inverse = covariance_of(all.S);
  if (!inverse) return tl::unexpected(inverse.error());
  const TensorResponse response(fit.state.sensors, fit.problem.geometry, mean_field(fit));
  JointProblem one = without_poses_and_priors(fit.problem);
  JointState state = fit.state;
  std::vector<PoseInfluence> out(fit.problem.poses.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    one.poses = {fit.problem.poses[k]};
    state.nuisances = {fit.state.nuisances[k]};
    Reduced share = reduce(one, state, 0);
    release_idle_slots(one, share.S);
    const double observations = observations_of(one.poses.front());
    if (observations > 0) out[k].leverage = share.S.cwiseProduct(*inverse).sum() / observations;
    const auto rest = linear::Cholesky::of(all.S - share.S);
    if (rest) {
      const WorstComponent worst = worst_component(response.shift(-rest->solve(share.g)));
      out[k].tensor_shift_nT_per_m = worst.value;
      out[k].component = worst.name;
    } else {
      out[k].tensor_shift_nT_per_m = kNotDetermined;
    }
  }
  return out;
}

}  // namespace mgtd::calib::fit::joint
