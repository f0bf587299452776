// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/residual.h"

#include <algorithm>
#include <cmath>

#include "calib/linear/qr.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// Columns shorter than this against their own length before elimination are rounding.
constexpr double kRankTolerance = 1e-9;

/// Ten times the noise of a reading over the field.
double absorbed_in(const fit::joint::JointProblem& problem) {
  constexpr double kNoises = 10;
  if (problem.sensors() > 1 || problem.poses.empty()) return kAbsorbed;
  double largest = 0;
  for (const fit::joint::JointPose& pose : problem.poses) {
    const double weight = pose.weight.maxCoeff(), size_nT = pose.y_nT.norm();
    if (weight > 0 && size_nT > 0) largest = std::max(largest, 1 / (weight * size_nT));
  }
  return std::max(kAbsorbed, std::min(0.1, kNoises * largest));
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
  const Eigen::MatrixXd white = whitener_.apply(rows);
  Columns out{.projected = Eigen::MatrixXd::Zero(value_.size(), rows.cols()), .norms = {}};
  out.norms = white.colwise().norm();
  out.projected.topRows(white.rows()) = white;
  out.projected.noalias() -= basis_ * (basis_.topRows(white.rows()).transpose() * white);
  out.projected /= unit_;
  out.norms /= unit_;
  return out;
}

}  // namespace mgtd::calib::criticism::tests
