// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/criticism/tests/residual.h"
#include "calib/criticism/tests/signature.h"
#include "calib/fit/joint/wandering_estimate.h"

/// A WanderingAlternative tells whether a law or offsets that wander describe the residual better. A drift, a
/// step or a temperature makes an offset move, and so does the slow noise of a fluxgate. Which of them it is,
/// two fits to the same residual decide, one with the law and one without it, in both of which every offset
/// wanders as fast as fits best:
///
///     R = 2 ln (max L with the law / max L without it)
///
/// is chi-square with the rank of the law where the offsets only wander. A test at the rates that were found
/// without the law would be blind to a slow law, because those rates have taken it up already.
namespace mgtd::calib::criticism::tests {

class WanderingAlternative {
 public:
  /// Of a fit in which nothing wanders.
  explicit WanderingAlternative(const fit::joint::JointFit& bare);
  WanderingAlternative(const WanderingAlternative&) = delete;  // slow_ refers to problem_
  WanderingAlternative& operator=(const WanderingAlternative&) = delete;

  [[nodiscard]] const fit::joint::WanderingEstimate& estimate() const { return estimate_; }

  struct Ratio {
    double R{0};
    /// 2 ln of the odds of the law in the place of the walk on its axes, against the walk alone.
    double instead{0};
    int rank{0};
  };
  /// Rows as effect_rows() gives them at problem() and state(), times the combination that is asked about.
  [[nodiscard]] Ratio ratio(const Eigen::MatrixXd& rows) const;

  /// 2 ln of the odds of a smooth curve over time on one channel, free in each of its terms, in the place of
  /// the walk there. A walk is largest where it is slowest; what oscillates is no walk.
  [[nodiscard]] double curve_instead(int channel) const;
  /// What still wanders where the law holds.
  [[nodiscard]] fit::joint::WanderingEstimate beside(const Eigen::MatrixXd& rows) const;

  [[nodiscard]] const fit::joint::JointProblem& problem() const { return problem_; }
  [[nodiscard]] const fit::joint::JointState& state() const { return state_; }

 private:
  /// Q' times the columns of the wandering, of projected columns Q.
  [[nodiscard]] Eigen::MatrixXd slow_by(const Eigen::MatrixXd& Q) const;
  /// Orthonormal, of the law's projected columns.
  [[nodiscard]] Eigen::MatrixXd basis_of(const Eigen::MatrixXd& rows) const;
  /// -2 ln of the maximum likelihood with a law, whose directions are out of `with`. The determinant does not
  /// know the law, the quadratic form does.
  [[nodiscard]] double deviance_with(const fit::joint::SlowLikelihood& with,
                                     const fit::joint::Channels& theta) const;

  fit::joint::JointProblem problem_;
  fit::joint::JointState state_;
  Residual residual_;      ///< nuisances and the model's own parameters out, poses uncorrelated
  double per_effective_;   ///< JointFit::samples_per_effective: what follows is thinned by it
  Eigen::VectorXd value_;  ///< of the residual
  Signature slow_;         ///< of the wandering, not thinned
  fit::joint::SlowLikelihood likelihood_;
  fit::joint::WanderingEstimate estimate_;
  fit::joint::Channels theta_;  ///< where the likelihood is largest without any law
  double deviance_{0};
};

}  // namespace mgtd::calib::criticism::tests
