// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/residual.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/fit/joint/single_samples.h"
#include "calib/linear/qr.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// Ten times the noise of a reading over the field, both as root mean squares over the poses.
double absorbed_in(const fit::joint::JointProblem& problem) {
  constexpr double kNoises = 10, kMost = 0.1;
  if (!fit::joint::reads_single_samples(problem)) return kAbsorbed;
  double noise_nT2 = 0, field_nT2 = 0;
  for (const fit::joint::JointPose& pose : problem.poses) {
    for (Eigen::Index c = 0; c < pose.weight.size(); ++c) {
      if (!(pose.weight[c] > 0)) continue;
      noise_nT2 += 1 / (pose.weight[c] * pose.weight[c]);
      field_nT2 += 3 * pose.y_nT[c] * pose.y_nT[c];  // three channels share one field
    }
  }
  if (!(field_nT2 > 0)) return kAbsorbed;
  return std::clamp(kNoises * std::sqrt(noise_nT2 / field_nT2), kAbsorbed, kMost);
}

}  // namespace

Residual::Residual(const fit::joint::JointProblem& problem, const fit::joint::JointState& state, double rho,
                   const fit::joint::WanderingRates& nT_per_sqrt_h)
    : poses_(static_cast<Eigen::Index>(problem.poses.size())), absorbed_(absorbed_in(problem)) {
  const LinearRows rows = observation_rows(problem, state);
  Whitener whitener(problem, rows.nuisance, rho, nT_per_sqrt_h);
  const PriorRows priors = prior_rows(problem, state);
  const Eigen::Index n = poses_ * whitener.rows_per_pose(), q = priors.residual.size();
  value_.resize(n + q);
  value_ << whitener.apply(rows.residual), priors.residual;
  Eigen::MatrixXd fixed(n + q, problem.fixed());
  whitener.apply(fixed_source(problem, state), fixed.topRows(n));
  fixed.bottomRows(q) = priors.fixed;
  const Eigen::VectorXd lengths = fixed.colwise().norm();
  Eigen::MatrixXd basis = linear::column_space(std::move(fixed), lengths, kRankTolerance);
  value_ -= basis * (basis.transpose() * value_);
  chi2_ = value_.squaredNorm();
  const auto constraints = (priors.fixed.rowwise().squaredNorm().array() > 0).count();
  dof_ = whitener.rank() + static_cast<double>(constraints) - static_cast<double>(basis.cols());
  projection_ = std::make_shared<const Projection>(std::move(whitener), std::move(basis));
}

void Residual::measure_by(double scale2) {
  const double unit = std::sqrt(scale2);
  value_ *= unit_ / unit;
  chi2_ *= unit_ * unit_ / scale2;
  unit_ = unit;
}

Residual::Columns Residual::project(const Eigen::MatrixXd& rows) const {
  Columns out = projection_->project(rows);
  out.projected /= unit_;
  out.norms /= unit_;
  return out;
}

}  // namespace mgtd::calib::criticism::tests
