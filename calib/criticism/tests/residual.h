// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>

#include "calib/criticism/tests/projection.h"
#include "calib/fit/joint/joint_fit.h"

/// A Residual is what a joint fit left over, ready for tests: nuisances, correlation between poses and every
/// direction that the model's own parameters can take have been removed. Under the model the residual is unit
/// normal in the space that is left, `dof` dimensions of it.
namespace mgtd::calib::criticism::tests {

/// Singular values below this share of a column's length before projection are rounding: absorbed.
inline constexpr double kAbsorbed = 1e-6;

class Residual {
 public:
  Residual() = default;  ///< of no run: only to be assigned to
  Residual(const fit::joint::JointProblem& problem, const fit::joint::JointState& state, double rho,
           const fit::joint::WanderingRates& nT_per_sqrt_h = {});

  /// A row for each reading, pose by pose, then the priors.
  [[nodiscard]] const Eigen::VectorXd& value() const { return value_; }
  [[nodiscard]] double chi2() const { return chi2_; }
  [[nodiscard]] double dof() const { return dof_; }
  [[nodiscard]] const Whitener& whitener() const { return projection_->whitener(); }
  [[nodiscard]] Eigen::Index poses() const { return poses_; }
  /// Rows of value() for one pose.
  [[nodiscard]] Eigen::Index rows_per_pose() const { return whitener().rows_per_pose(); }
  [[nodiscard]] Eigen::Index channels() const { return whitener().channels(); }

  /// Share of its length below which a projected column says nothing. Laws are functions of the readings,
  /// which are known to their noise only: with single samples of one sensor that is more than rounding, and
  /// what is left of an absorbed law is the noise that the residual has too.
  [[nodiscard]] double absorbed() const { return absorbed_; }

  /// What lengths are divided by: square root of the last scale2.
  [[nodiscard]] double unit() const { return unit_; }

  /// From now on everything is in units of noise with `scale2` times the variance of the weights.
  void measure_by(double scale2);

  using Columns = Projection::Columns;
  /// Rows as effect_rows() gives them.
  [[nodiscard]] Columns project(const Eigen::MatrixXd& rows) const;
  /// What project() does, before units.
  [[nodiscard]] const std::shared_ptr<const Projection>& projection() const { return projection_; }

  /// Orthonormal, of the directions that the model's own parameters can take.
  [[nodiscard]] const Eigen::MatrixXd& basis() const { return projection_->basis(); }

 private:
  std::shared_ptr<const Projection> projection_;
  Eigen::Index poses_{0};
  Eigen::VectorXd value_;
  double chi2_{0}, dof_{0};
  double unit_{1};
  double absorbed_{kAbsorbed};
};

}  // namespace mgtd::calib::criticism::tests
