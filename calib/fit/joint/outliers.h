// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/fit/joint/pose_blame.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/fit/joint/stretch_scan.h"
#include "calib/fit/outlier_node.h"

/// Outliers finds observations that the other data contradict. Each stays in the table, is left out of the
/// sums, and is listed with the shift that would reconcile it (mean-shift outlier model). Nothing is ever
/// dropped silently, and what fits after all comes back.
///
/// A law that the model misses is not cured by leaving out where it is largest: limits go by the spread of
/// each axis over all poses, and an axis that loses many readings keeps them all where no gap parts them from
/// the others.
namespace mgtd::calib::fit::joint {

/// The set of observations left out.
class Outliers {
 public:
  explicit Outliers(double most = 1.0 / 3) : most_(most) {}
  /// Judges every pose afresh against this state (pose_blame.h) and leaves out what it is to blame for;
  /// returns whether the set changed. No more than the given share of the poses: where more of them
  /// contradict, it is the model that fails, and nothing is left out.
  bool judge(JointProblem& problem, const JointState& state, const PoseResiduals& residuals);
  /// The same by limits of the caller.
  bool judge(JointProblem& problem, const JointState& state, const PoseResiduals& residuals,
             BlameLimits limits);
  /// Gives every observation its weight back, for a while: between this and leave_out() weights may be set.
  void restore(JointProblem& problem) const;
  void leave_out(JointProblem& problem);

  /// Leaves these readings of a stretch out whatever each of its poses shows by itself: no pose of it is
  /// judged again.
  void keep_out(JointProblem& problem, const ShiftedStretch& stretch);
  /// The same in these poses.
  void keep_out(JointProblem& problem, const std::vector<std::size_t>& poses, const Rows& rows);

  [[nodiscard]] bool any() const { return share() > 0; }
  /// Poses of which something is left out, of all poses.
  [[nodiscard]] double share() const;
  /// Poses that contradicted when there were too many of them to be left out, of all poses; else zero.
  [[nodiscard]] double too_many() const { return too_many_; }
  [[nodiscard]] const std::vector<Rows>& rows() const { return left_out_; }
  [[nodiscard]] std::vector<OutlierNode> nodes(const JointProblem& problem, const JointState& state) const;

 private:
  struct Weights {
    Channels readings;
    double scalar{0}, attitude{0};
  };
  [[nodiscard]] OutlierNode node(const JointProblem& whole, const JointState& state, std::size_t k,
                                 int row) const;
  [[nodiscard]] std::vector<Rows> blamed(const JointProblem& whole, const JointState& state,
                                         const BlameLimits& limits, const std::vector<std::size_t>& examined);
  [[nodiscard]] bool spare_tails(const PoseResiduals& residuals, const std::vector<Rows>& found,
                                 BlameLimits& limits);
  void widen_tails(const PoseResiduals& residuals, BlameLimits& limits) const;
  void fill_stretches(int channels);
  void fill_saturated(const JointProblem& problem);

  double most_;
  std::vector<Rows> left_out_;                ///< by pose
  std::vector<Weights> weight_;               ///< of every pose, before anything was left out
  std::vector<int> changed_;                  ///< how often the judgement of the pose did
  std::vector<double> sigmas_;                ///< worst misfit of the pose when it was judged
  std::bitset<sensor::kMostChannels> tails_;  ///< channels whose misfit has no gap: a law, not gross readings
  double too_many_{0};
  int given_up_{0};  ///< how often there were too many
};

}  // namespace mgtd::calib::fit::joint
