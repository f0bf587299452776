// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/wandering_alternative.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/linear/qr.h"

namespace mgtd::calib {
namespace {

constexpr int kClimbs = 5;  ///< from rates that are near: a law takes away from some of them
constexpr double kAbsorbedShare = 1e-6;

/// One column per channel and term, in the order of SlowSums.
Eigen::MatrixXd slow_rows(const JointProblem& problem) {
  const WanderingTerms terms = wandering_terms(problem);
  const auto rows = static_cast<Eigen::Index>(problem.poses.size()) * kPoseRows;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, terms.any() ? kChannels * kWanderingTerms : 0);
  for (std::size_t k = 0; terms.any() && k < problem.poses.size(); ++k) {
    const JointPose& pose = problem.poses[k];
    for (int c = 0; c < kChannels; ++c) {
      out.block<1, kWanderingTerms>(static_cast<Eigen::Index>(k) * kPoseRows + c, c * kWanderingTerms) =
          pose.weight[c] * terms.at(pose.t_h).transpose();
    }
  }
  return out;
}

SlowSums sums_of(const Residual& residual, const Eigen::MatrixXd& slow) {
  SlowSums out{.gram = Eigen::MatrixXd::Zero(slow.cols(), slow.cols()),
               .by_residual = slow.transpose() * residual.value(),
               .chi2 = residual.chi2(),
               .dof = residual.dof()};
  out.gram.selfadjointView<Eigen::Lower>().rankUpdate(slow.transpose());
  out.gram.triangularView<Eigen::StrictlyUpper>() = out.gram.transpose();
  return out;
}

/// Relative variances of an estimate.
Channels relative(const WanderingEstimate& estimate, const SlowLikelihood& likelihood) {
  // The noise that the rates stand beside follows from them: two rounds settle it.
  Channels theta = estimate.nT_per_sqrt_h.cwiseAbs2();
  for (int i = 0; i < 2; ++i) theta = estimate.nT_per_sqrt_h.cwiseAbs2() / likelihood.noise_variance(theta);
  return theta;
}

/// Squares of what each channel feels of a law.
Channels felt(const Eigen::MatrixXd& rows) {
  Channels out = Channels::Zero();
  for (Eigen::Index k = 0; k < rows.rows(); k += kPoseRows)
    out += rows.middleRows<kChannels>(k).rowwise().squaredNorm();
  return out;
}

}  // namespace

WanderingAlternative::WanderingAlternative(const JointFit& bare)
    : problem_(bare.problem),
      state_(bare.state),
      residual_(problem_, state_, 0),
      slow_(residual_.project(slow_rows(problem_)).projected),
      likelihood_(sums_of(residual_, slow_)),
      estimate_(estimate_wandering(likelihood_)),
      theta_(Channels::Zero()) {
  if (!estimate_.any()) return;
  theta_ = relative(estimate_, likelihood_);
  likelihood_.climb(theta_, kClimbs);
  deviance_ = likelihood_.deviance(theta_);
}

WanderingAlternative::Ratio WanderingAlternative::ratio(const Eigen::MatrixXd& rows) const {
  const Eigen::MatrixXd Q = basis_of(rows);
  if (Q.cols() == 0) return {};
  const SlowLikelihood with(
      likelihood_.sums().without(Q.transpose() * slow_, Q.transpose() * residual_.value()));
  const auto deviance = [&](const Channels& at) { return deviance_with(with, at); };
  // From rates that are too high the likelihood is climbed slowly: begin with those of the others, and with
  // none, too.
  const Channels here = felt(rows);
  Channels low = theta_;
  double usual = std::numeric_limits<double>::infinity();
  for (int c = 0; c < kChannels; ++c)
    if (here[c] == 0 && theta_[c] > 0) usual = std::min(usual, theta_[c]);
  for (int c = 0; c < kChannels; ++c)
    if (here[c] > 0) low[c] = std::isinf(usual) ? 0 : std::min(usual, theta_[c]);
  double least = std::min({deviance(theta_), deviance(low), deviance(Channels::Zero())});
  for (Channels theta : {theta_, low}) {
    with.climb(theta, kClimbs);
    least = std::min(least, deviance(theta));
  }
  return {.R = deviance_ - least, .instead = deviance_ - deviance(low), .rank = static_cast<int>(Q.cols())};
}

double WanderingAlternative::deviance_with(const SlowLikelihood& with, const Channels& theta) const {
  return likelihood_.deviance(theta) +
         likelihood_.sums().dof * std::log(with.quadratic(theta) / likelihood_.quadratic(theta));
}

double WanderingAlternative::curve_instead(int channel) const {
  constexpr int kCurve = 8;
  const Eigen::MatrixXd columns = slow_.middleCols(channel * kWanderingTerms, kCurve);
  const Eigen::MatrixXd Q = orthonormal(columns);
  const Eigen::VectorXd r = Q.transpose() * residual_.value();
  const SlowLikelihood with(likelihood_.sums().without(Q.transpose() * slow_, r));
  Channels others = theta_;
  others[channel] = 0;
  const double S = r.squaredNorm() * with.sums().dof / with.sums().chi2;
  return deviance_ - deviance_with(with, others) - kCurve * std::log1p(S);
}

WanderingEstimate WanderingAlternative::beside(const Eigen::MatrixXd& rows) const {
  const Eigen::MatrixXd Q = basis_of(rows);
  return estimate_wandering(
      SlowLikelihood(likelihood_.sums().without(Q.transpose() * slow_, Q.transpose() * residual_.value())));
}

Eigen::MatrixXd WanderingAlternative::basis_of(const Eigen::MatrixXd& rows) const {
  const auto columns = residual_.project(rows);
  return column_space(columns.projected, columns.norms, kAbsorbedShare);
}

}  // namespace mgtd::calib
