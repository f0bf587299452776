// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/fit/outlier_node.h"
#include "calib/fit/pose_residuals.h"

/// Observations that the rest of the data contradicts. Each stays in the table, is left out of the sums, and
/// is listed with the shift that would reconcile it (mean-shift outlier model). Nothing is ever dropped
/// silently.
namespace mgtd::calib {

/// The set of observations left out, grown from the worst downwards and checked again at the end.
class Outliers {
 public:
  /// Leaves out the worst observation of each pose that stands out, worst poses first; returns whether any
  /// was. A tenth of the poses at most: more is a model that fails, not bad poses.
  bool exclude(JointProblem& problem, const PoseResiduals& residuals);
  /// Takes back, once each, what fits after all now that worse ones are gone; returns whether any was. Of a
  /// pose that lost several: all but the one without which the others agree, where there is one. A reading
  /// that is far off bends attitude and field of its pose, and the poses' own parameters of its axis with
  /// them: then good ones look worse than it does.
  bool restore(JointProblem& problem, const JointState& state);
  [[nodiscard]] std::vector<OutlierNode> nodes(const JointProblem& problem, const JointState& state) const;

 private:
  struct Suspect {
    std::size_t pose{0};
    int row{0};  ///< channel, kScalarRow or kAttitudeRow
    double t{0};
    double weight{0};  ///< it had, to give back
  };
  using Spreads = Eigen::Array<double, kObservations, 1>;

  [[nodiscard]] std::vector<Suspect> find(const PoseResiduals& residuals) const;
  [[nodiscard]] bool restore_all_but_one(JointProblem& problem, const JointState& state);
  [[nodiscard]] double worst_without(const JointProblem& problem, const JointState& state,
                                     const Suspect& culprit) const;
  void take_back(JointProblem& problem, std::vector<Suspect>::iterator from);

  Spreads spread_{Spreads::Ones()};  ///< of t over the poses, as last seen
  std::vector<Suspect> left_out_, taken_back_;
};

}  // namespace mgtd::calib
