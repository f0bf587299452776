// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/wandering_covariance.h"

#include <algorithm>

#include "calib/fit/joint/filled_in_error.h"
#include "calib/fit/joint/followed_pose.h"
#include "calib/fit/joint/joint_solver.h"
#include "calib/linear/cholesky.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Of the white noise, over that of the weights: what all readings have, and beside it by channel.
struct WhiteNoise {
  double common;
  Channels beside;
};

/// From pose to pose the terms of a wandering offset beyond the last look white. Where the dwells say how
/// large the white noise is at least, those terms account for what noise_scale2 has above it, as far as the
/// size of the wandering asks for that.
WhiteNoise white_noise(const JointFit& fit, const WanderingEstimate& w, const WanderingTerms& terms) {
  const Eigen::Index channels = fit.problem.channels();
  WhiteNoise out{w.noise_scale2, Channels::Zero(channels)};
  const double least = 1 / (fit.noise_inflation * fit.noise_inflation);
  if (!fit.sample_noise_nT || out.common <= least) return out;
  // One size for all that wander: those of single channels are known to a fifth at best.
  const Channels wanders = (w.size.array() > 0).cast<double>();
  const double beyond_nT2 = w.size.squaredNorm() / wanders.sum() * terms.variance_beyond();
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(channels, 2);  // of what lies beyond, and of freedom
  sums = sum_over_followed(fit.problem, fit.state, sums,
                           [&](const JointPose& pose, const FollowedPose& f, Eigen::MatrixXd& sum) {
                             sum.col(0) += beyond_nT2 * wanders.cwiseProduct(pose.weight.cwiseAbs2());
                             sum.col(1) += f.readings.diagonal();
                           });
  const Channels beyond = sums.col(0) / static_cast<double>(fit.problem.poses.size()), freedom = sums.col(1);
  const double mean = beyond.dot(freedom) / freedom.sum();
  if (!(mean > 0)) return out;
  const double share = std::min(1.0, (out.common - least) / mean);
  out.common -= share * mean;
  out.beside = share * beyond;
  return out;
}

/// What the white noise of single channels adds to the covariance of the fixed block, pose by pose: a product
/// of three matrices would lose what a coarse table knows of the common rotation.
Eigen::MatrixXd covariance_beside(const JointProblem& problem, const JointState& state,
                                  const linear::Cholesky& information, const Channels& beside) {
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(problem.fixed(), problem.fixed());
  if (!(beside.maxCoeff() > 0)) return nothing;
  const Channels sd = beside.cwiseSqrt();
  return sum_over_followed(
      problem, state, nothing, [&](const JointPose&, const FollowedPose& f, Eigen::MatrixXd& out) {
        const Eigen::MatrixXd errors = information.solve(Eigen::MatrixXd(f.by_fixed * sd.asDiagonal()));
        out.noalias() += errors * errors.transpose();
      });
}

}  // namespace

std::optional<Eigen::MatrixXd> covariance_with_wandering(const JointFit& fit, const Reduced& equations,
                                                         const SlowCosines& cosines,
                                                         const WanderingEstimate& w) {
  const WanderingTerms terms = wandering_terms(fit.problem, w.spectrum);
  const auto information = linear::Cholesky::of(equations.S);
  if (!information || !terms.any()) return std::nullopt;
  const WhiteNoise white = white_noise(fit, w, terms);
  Eigen::MatrixXd errors = information->solve(cosines.of(terms).by_fixed);
  Eigen::MatrixXd out = white.common * information->inverse() +
                        covariance_beside(fit.problem, fit.state, *information, white.beside);
  out = fit.samples_per_effective * out + filled_in_error(fit, equations);
  const auto by_end = terms.by_end();
  for (int c = 0; c < fit.problem.channels(); ++c) {
    const int offset = sensor::kSensorParameters * (c / 3) + sensor::ix + c % 3;
    errors.row(offset).segment<kWanderingTerms>(c * kWanderingTerms) -= by_end.transpose();
    errors.middleCols<kWanderingTerms>(c * kWanderingTerms) *= w.size[c];
    out(offset, offset) += w.size[c] * w.size[c] * (terms.variance_at_end() - by_end.squaredNorm());
  }
  return Eigen::MatrixXd(out + errors * errors.transpose());
}

}  // namespace mgtd::calib::fit::joint
