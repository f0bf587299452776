// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/wandering_alternative.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "calib/linear/qr.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr int kClimbs = 5;  ///< from rates that are near: a law takes away from some of them
constexpr double kAbsorbedShare = 1e-6;

/// One column per channel and term, in the order of SlowSums; none where the poses have no time.
RowSource slow_source(const fit::joint::JointProblem& problem) {
  const fit::joint::WanderingTerms terms = fit::joint::wandering_terms(problem);
  RowSource out{.columns = terms.any() ? problem.channels() * fit::joint::kWanderingTerms : 0};
  Eigen::Matrix<double, fit::joint::kWanderingTerms, Eigen::Dynamic> at(
      fit::joint::kWanderingTerms, out.columns > 0 ? static_cast<Eigen::Index>(problem.poses.size()) : 0);
  for (Eigen::Index k = 0; k < at.cols(); ++k)
    at.col(k) = terms.at(problem.poses[static_cast<std::size_t>(k)].t_h);
  out.of = [&problem, at = std::move(at), columns = out.columns](std::span<const Eigen::Index> poses) {
    const Eigen::Index block = problem.pose_rows();
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(poses.size()) * block, columns);
    Eigen::Index row = 0;
    for (const Eigen::Index k : poses) {
      const fit::joint::JointPose& pose = problem.poses[static_cast<std::size_t>(k)];
      for (int c = 0; columns > 0 && c < problem.channels(); ++c) {
        rows.block<1, fit::joint::kWanderingTerms>(row + c, c * fit::joint::kWanderingTerms) =
            pose.weight[c] * at.col(k).transpose();
      }
      row += block;
    }
    return rows;
  };
  return out;
}

fit::joint::SlowSums sums_of(const Residual& residual, const Signature& slow, double per_effective) {
  return {.gram = slow.gram() / per_effective,
          .by_residual = slow.by_residual() / per_effective,
          .chi2 = residual.chi2() / per_effective,
          .dof = residual.dof() / per_effective};
}

/// Relative variances of an estimate.
fit::joint::Channels relative(const fit::joint::WanderingEstimate& estimate,
                              const fit::joint::SlowLikelihood& likelihood) {
  // The noise that the rates stand beside follows from them: two rounds settle it.
  fit::joint::Channels theta = estimate.size.cwiseAbs2();
  for (int i = 0; i < 2; ++i) theta = estimate.size.cwiseAbs2() / likelihood.noise_variance(theta);
  return theta;
}

/// Squares of what each channel feels of a law.
fit::joint::Channels felt(const fit::joint::JointProblem& problem, const Eigen::MatrixXd& rows) {
  fit::joint::Channels out = fit::joint::Channels::Zero(problem.channels());
  for (Eigen::Index k = 0; k < rows.rows(); k += problem.pose_rows())
    out += rows.middleRows(k, problem.channels()).rowwise().squaredNorm();
  return out;
}

}  // namespace

WanderingAlternative::WanderingAlternative(const fit::joint::JointFit& bare)
    : problem_(bare.problem),
      state_(bare.state),
      residual_(problem_, state_, 0),
      per_effective_(bare.samples_per_effective),
      value_(residual_.value() / std::sqrt(per_effective_)),
      slow_(residual_, slow_source(problem_)),
      likelihood_(sums_of(residual_, slow_, per_effective_)),
      estimate_(fit::joint::estimate_wandering(likelihood_)),
      theta_(fit::joint::Channels::Zero(problem_.channels())) {
  if (!estimate_.any()) return;
  theta_ = relative(estimate_, likelihood_);
  likelihood_.climb(theta_, kClimbs, fit::joint::Channels::Zero(theta_.size()));
  deviance_ = likelihood_.deviance(theta_);
}

WanderingAlternative::Ratio WanderingAlternative::ratio(const Eigen::MatrixXd& rows) const {
  const Eigen::MatrixXd Q = basis_of(rows);
  if (Q.cols() == 0) return {};
  const fit::joint::SlowLikelihood with(likelihood_.sums().without(slow_by(Q), Q.transpose() * value_));
  const auto deviance = [&](const fit::joint::Channels& at) { return deviance_with(with, at); };
  // From rates that are too high the likelihood is climbed slowly: begin with those of the others, and with
  // none, too.
  const fit::joint::Channels here = felt(problem_, rows);
  fit::joint::Channels low = theta_;
  double usual = std::numeric_limits<double>::infinity();
  for (Eigen::Index c = 0; c < theta_.size(); ++c)
    if (here[c] == 0 && theta_[c] > 0) usual = std::min(usual, theta_[c]);
  for (Eigen::Index c = 0; c < theta_.size(); ++c)
    if (here[c] > 0) low[c] = std::isinf(usual) ? 0 : std::min(usual, theta_[c]);
  double least =
      std::min({deviance(theta_), deviance(low), deviance(fit::joint::Channels::Zero(problem_.channels()))});
  for (fit::joint::Channels theta : {theta_, low}) {
    with.climb(theta, kClimbs, fit::joint::Channels::Zero(theta.size()));
    least = std::min(least, deviance(theta));
  }
  return {.R = deviance_ - least, .instead = deviance_ - deviance(low), .rank = static_cast<int>(Q.cols())};
}

double WanderingAlternative::deviance_with(const fit::joint::SlowLikelihood& with,
                                           const fit::joint::Channels& theta) const {
  return likelihood_.deviance(theta) +
         likelihood_.sums().dof * std::log(with.quadratic(theta) / likelihood_.quadratic(theta));
}

double WanderingAlternative::curve_instead(int channel) const {
  constexpr int kCurve = 8;
  Eigen::MatrixXd first = Eigen::MatrixXd::Zero(slow_.cols(), kCurve);
  first.middleRows<kCurve>(channel * fit::joint::kWanderingTerms).setIdentity();
  const Eigen::MatrixXd Q = linear::orthonormal(slow_.times(first));
  const Eigen::VectorXd r = Q.transpose() * value_;
  const fit::joint::SlowLikelihood with(likelihood_.sums().without(slow_by(Q), r));
  fit::joint::Channels others = theta_;
  others[channel] = 0;
  const double S = r.squaredNorm() * with.sums().dof / with.sums().chi2;
  return deviance_ - deviance_with(with, others) - kCurve * std::log1p(S);
}

fit::joint::WanderingEstimate WanderingAlternative::beside(const Eigen::MatrixXd& rows) const {
  const Eigen::MatrixXd Q = basis_of(rows);
  return fit::joint::estimate_wandering(
      fit::joint::SlowLikelihood(likelihood_.sums().without(slow_by(Q), Q.transpose() * value_)));
}

Eigen::MatrixXd WanderingAlternative::slow_by(const Eigen::MatrixXd& Q) const {
  return slow_.transposed_times(Q).transpose() / std::sqrt(per_effective_);
}

Eigen::MatrixXd WanderingAlternative::basis_of(const Eigen::MatrixXd& rows) const {
  const auto columns = residual_.project(rows);
  return linear::column_space(columns.projected, columns.norms, kAbsorbedShare);
}

}  // namespace mgtd::calib::criticism::tests
