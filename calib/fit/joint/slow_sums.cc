// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/slow_sums.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "calib/fit/joint/followed_pose.h"
#include "calib/linear/cholesky.h"

namespace mgtd::calib::fit::joint {

namespace {

constexpr Eigen::Index kMultiples = 2 * kWanderingTerms + 1;
using Multiples = Eigen::Matrix<double, kMultiples, 1>;

/// cos(m x), m from 0.
Multiples cosines_of_multiples(double x) {
  Multiples out;
  const std::complex<double> turn = std::polar(1.0, x);
  std::complex<double> turned = 1;
  for (Eigen::Index m = 0; m < kMultiples; ++m, turned *= turn) out[m] = turned.real();
  return out;
}

Eigen::Index pair_of(Eigen::Index c, Eigen::Index d) { return c * (c + 1) / 2 + d; }

}  // namespace

SlowCosines::SlowCosines(const JointProblem& problem, const JointState& state)
    : channels_(problem.channels()), fixed_(problem.fixed()) {
  const WanderingTerms run = wandering_terms(problem);
  if (!run.any()) return;
  const Sums nothing{.by_fixed = Eigen::MatrixXd::Zero(fixed_ * channels_, kWanderingTerms),
                     .products = Eigen::MatrixXd::Zero(kMultiples, pair_of(channels_, 0)),
                     .by_residual = Eigen::MatrixXd::Zero(kWanderingTerms, channels_)};
  const auto add = [&](const JointPose& pose, const FollowedPose& f, Sums& out) {
    const auto w = pose.weight.asDiagonal();
    const Multiples multiples = cosines_of_multiples(run.phase(pose.t_h));
    const auto cosines = std::numbers::sqrt2 * multiples.segment<kWanderingTerms>(1);
    const Eigen::MatrixXd X = f.by_fixed * w;
    for (Eigen::Index j = 0; j < kWanderingTerms; ++j) out.by_fixed.col(j) += cosines[j] * X.reshaped();
    for (Eigen::Index c = 0; c < channels_; ++c) {
      out.by_residual.col(c) += pose.weight[c] * f.residual[c] * cosines;
      for (Eigen::Index d = 0; d <= c; ++d)
        out.products.col(pair_of(c, d)) += pose.weight[c] * f.readings(c, d) * pose.weight[d] * multiples;
    }
  };
  sums_ = sum_over_followed(problem, state, nothing, add);
}

SlowEquations SlowCosines::of(const WanderingTerms& terms) const {
  constexpr Eigen::Index kJ = kWanderingTerms;
  if (sums_.products.size() == 0) return {};
  const auto& L = terms.factor();
  SlowEquations out{.by_fixed = Eigen::MatrixXd(fixed_, channels_ * kJ),
                    .gram = Eigen::MatrixXd(channels_ * kJ, channels_ * kJ),
                    .by_residual = (L.transpose() * sums_.by_residual).reshaped()};
  for (Eigen::Index c = 0; c < channels_; ++c) {
    out.by_fixed.middleCols<kJ>(c * kJ) = sums_.by_fixed.middleRows(c * fixed_, fixed_) * L;
    for (Eigen::Index d = 0; d <= c; ++d) {
      const auto sums = sums_.products.col(pair_of(c, d));
      const auto product = [&](Eigen::Index i, Eigen::Index j) {
        return sums[std::abs(i - j)] + sums[i + j + 2];  // terms count from 1
      };
      out.gram.block<kJ, kJ>(c * kJ, d * kJ) =
          L.transpose() * Eigen::Matrix<double, kJ, kJ>::NullaryExpr(product) * L;
    }
  }
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

SlowSums slow_sums(const JointFit& fit, const Reduced& equations, const SlowCosines& cosines,
                   SlowSpectrum spectrum) {
  const WanderingTerms terms = wandering_terms(fit.problem, spectrum);
  if (!terms.any()) return {};
  const SlowEquations slow = cosines.of(terms);
  const auto information = linear::Cholesky::of(equations.S);
  if (!information) return {};
  const Eigen::MatrixXd X = information->whiten(slow.by_fixed);
  const Eigen::VectorXd y = information->whiten(equations.g);
  return {.gram = slow.gram - X.transpose() * X,
          .by_residual = slow.by_residual - X.transpose() * y,
          .chi2 = equations.cost.total() - y.squaredNorm(),
          .dof = fit.dof + fit.dof_table};
}

}  // namespace mgtd::calib::fit::joint
