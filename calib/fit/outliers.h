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
  /// Takes back, once each, what fits after all now that worse ones are gone; returns whether any was.
  bool restore(JointProblem& problem, const JointState& state);
  [[nodiscard]] std::vector<OutlierNode> nodes(const JointProblem& problem, const JointState& state) const;

 private:
  struct Suspect {
    std::size_t pose{0};
    int row{0};  ///< channel, kScalarRow or kAttitudeRow
    double t{0};
    double weight{0};  ///< it had, to give back
  };
  [[nodiscard]] std::vector<Suspect> find(const PoseResiduals& residuals) const;
  std::vector<Suspect> left_out_, taken_back_;
};

}  // namespace mgtd::calib
