// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/residual.h"

#include <algorithm>
#include <cmath>

#include "calib/fit/joint/single_samples.h"
#include "calib/linear/product.h"
#include "calib/linear/qr.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// Columns shorter than this against their own length before elimination are rounding.
constexpr double kRankTolerance = 1e-9;

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

/// What the unknowns of the poses take whole is rounding, and no direction.
Eigen::MatrixXd without_rounding(Eigen::MatrixXd white, const Eigen::RowVectorXd& before) {
  for (Eigen::Index j = 0; j < white.cols(); ++j)
    if (white.col(j).norm() < kRankTolerance * before[j]) white.col(j).setZero();
  return white;
}

}  // namespace

Residual::Residual(const fit::joint::JointProblem& problem, const fit::joint::JointState& state, double rho,
                   const fit::joint::WanderingRates& nT_per_sqrt_h)
    : Residual(problem, state, linear_rows(problem, state), rho, nT_per_sqrt_h) {}

Residual::Residual(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                   const LinearRows& rows, double rho, const fit::joint::WanderingRates& nT_per_sqrt_h)
    : whitener_(problem, rows.nuisance, rho, nT_per_sqrt_h),
      poses_(static_cast<Eigen::Index>(problem.poses.size())) {
  absorbed_ = absorbed_in(problem);
  const PriorRows priors = prior_rows(problem, state);
  Eigen::MatrixXd all(rows.fixed.rows(), rows.fixed.cols() + 1);
  all << rows.fixed, rows.residual;
  const Eigen::MatrixXd white = whitener_.apply(all);
  const Eigen::Index n = white.rows(), q = priors.residual.size(), p = problem.fixed();
  Eigen::MatrixXd fixed(n + q, p);
  fixed << white.leftCols(p), priors.fixed;
  value_.resize(n + q);
  value_ << white.col(p), priors.residual;
  basis_ = linear::column_space(fixed, fixed.colwise().norm(), kRankTolerance);
  value_ -= basis_ * (basis_.transpose() * value_);
  chi2_ = value_.squaredNorm();
  const auto constraints = (priors.fixed.rowwise().squaredNorm().array() > 0).count();
  dof_ = whitener_.rank() + static_cast<double>(constraints) - static_cast<double>(basis_.cols());
}

void Residual::measure_by(double scale2) {
  const double unit = std::sqrt(scale2);
  value_ *= unit_ / unit;
  chi2_ *= unit_ * unit_ / scale2;
  unit_ = unit;
}

Residual::Columns Residual::project(const Eigen::MatrixXd& rows) const {
  const Eigen::MatrixXd white = without_rounding(whitener_.apply(rows), rows.colwise().norm());
  Columns out{.projected = Eigen::MatrixXd::Zero(value_.size(), rows.cols()), .norms = {}};
  out.norms = white.colwise().norm();
  out.projected.topRows(white.rows()) = white;
  linear::subtract_product(basis_, linear::transposed_product(basis_.topRows(white.rows()), white),
                           out.projected);
  out.projected /= unit_;
  out.norms /= unit_;
  return out;
}

}  // namespace mgtd::calib::criticism::tests
