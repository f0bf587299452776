// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/wandering.h"

/// slow_sums() computes what a joint fit says about the terms of offsets that wander (wandering.h): its
/// normal equations are bordered by one column per channel and term, for offsets of unit size. Column
/// kWanderingTerms c + j is term j of channel c. SlowCosines goes through the poses once, for every spectrum.
namespace mgtd::calib::fit::joint {

/// The terms of the run of these poses.
[[nodiscard]] WanderingTerms wandering_terms(const JointProblem& problem,
                                             SlowSpectrum spectrum = SlowSpectrum::walk);

/// What the slow terms add to the normal equations, nuisances eliminated.
struct SlowEquations {
  Eigen::MatrixXd by_fixed;  ///< fixed block x slow
  Eigen::MatrixXd gram;      ///< slow x slow
  Eigen::VectorXd by_residual;
};

/// Sums over the poses of what they contribute times the cosines of the run. The products of two cosines are
/// sums of two, 2 cos(i x) cos(j x) = cos((i - j) x) + cos((i + j) x), so 2 kWanderingTerms + 1 of them hold
/// the whole gram matrix of two channels.
class SlowCosines {
 public:
  SlowCosines(const JointProblem& problem, const JointState& state);
  /// `terms` of the same run. Empty where the poses have no time.
  [[nodiscard]] SlowEquations of(const WanderingTerms& terms) const;

 private:
  struct Sums {
    Eigen::MatrixXd by_fixed;     ///< fixed block x channels, in one column, by cosine
    Eigen::MatrixXd products;     ///< cosine of a multiple by pair of channels
    Eigen::MatrixXd by_residual;  ///< cosine by channel
    Sums& operator+=(const Sums& other) {
      by_fixed += other.by_fixed, products += other.products, by_residual += other.by_residual;
      return *this;
    }
  };
  Eigen::Index channels_, fixed_;
  Sums sums_;
};

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

/// With the normal equations of the fit, undamped, and its cosines. Empty gram where the poses have no time.
[[nodiscard]] SlowSums slow_sums(const JointFit& fit, const Reduced& equations, const SlowCosines& cosines,
                                 SlowSpectrum spectrum = SlowSpectrum::walk);

}  // namespace mgtd::calib::fit::joint
