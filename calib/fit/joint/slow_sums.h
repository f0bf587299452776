// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/wandering.h"

/// slow_sums() computes what a joint fit says about the terms of offsets that wander (wandering.h): its
/// normal equations are bordered by one column per channel and term, for offsets of unit size. Column
/// kWanderingTerms c + j is term j of channel c.
namespace mgtd::calib::fit::joint {

/// The terms of the run of these poses.
[[nodiscard]] WanderingTerms wandering_terms(const JointProblem& problem,
                                             SlowSpectrum spectrum = SlowSpectrum::walk);

/// What the slow terms add to the normal equations, nuisances eliminated.
struct SlowEquations {
  Eigen::MatrixXd by_fixed;  ///< fixed block x slow
  Eigen::MatrixXd gram;      ///< slow x slow
  Eigen::VectorXd by_residual;

  SlowEquations& operator+=(const SlowEquations& other) {
    by_fixed += other.by_fixed, gram += other.gram, by_residual += other.by_residual;
    return *this;
  }
};

[[nodiscard]] SlowEquations slow_equations(const JointProblem& problem, const JointState& state,
                                           const WanderingTerms& terms);

/// Products of the slow terms U with each other and with the residual r, everything else of the model
/// projected out.
struct SlowSums {
  Eigen::MatrixXd gram;         ///< U' U
  Eigen::VectorXd by_residual;  ///< U' r
  double chi2{0};               ///< r' r
  double dof{0};                ///< dimensions of r
  [[nodiscard]] int channels() const { return static_cast<int>(gram.rows()) / kWanderingTerms; }
  /// The sums of as many independent samples as the correlated ones are worth, `per_effective` of which count
  /// as one: a walk is slow, and meets their noise as it is at low frequencies.
  [[nodiscard]] SlowSums thinned(double per_effective) const;

  /// With the directions of some orthonormal columns taken out: `by_columns` = Q'U, `r` = Q'r.
  [[nodiscard]] SlowSums without(const Eigen::MatrixXd& by_columns, const Eigen::VectorXd& r) const;
};

/// Empty gram where the poses have no time.
[[nodiscard]] SlowSums slow_sums(const JointFit& fit, SlowSpectrum spectrum = SlowSpectrum::walk);

}  // namespace mgtd::calib::fit::joint
