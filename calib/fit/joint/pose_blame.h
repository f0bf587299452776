// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bitset>
#include <span>

#include "calib/fit/joint/joint_problem.h"
#include "calib/fit/joint/pose_model.h"
#include "calib/fit/joint/pose_residuals.h"

/// A PoseBlame finds which observations of one pose a calibration contradicts: the fewest without which the
/// others of the pose agree with it.
namespace mgtd::calib::fit::joint {

using Rows = std::bitset<kMostObservations>;  ///< readings, scalar, attitude

/// The readings of one sensor, counted from zero.
[[nodiscard]] inline Rows rows_of_sensor(int sensor) {
  return Rows(0b111ULL << static_cast<unsigned>(3 * sensor));
}

/// What a pose may show before something of it is left out, all in robust spreads of the run's own misfits
/// (never of the nominal noise alone, but in of_groups()): a single observation, the three readings of a
/// sensor, all of the pose. Sensors and poses are judged by the root of the sum of squares.
struct BlameLimits {
  Observations spread;
  double single{0};
  Eigen::Array<double, Eigen::Dynamic, 1, 0, kMostSensors, 1> sensor;
  double pose{0};

  /// Limits from the misfits of all poses; those of observations that are left out count as beyond any limit,
  /// so that leaving out does not narrow the limits of the others.
  [[nodiscard]] static BlameLimits of(const PoseResiduals& residuals, std::span<const Rows> left_out);
  /// Limits in units of the noise that the weights state, with which good readings must agree: for a sensor
  /// that is off in many poses, in each by too little to show.
  [[nodiscard]] static BlameLimits of_groups(const PoseResiduals& residuals);
  /// The largest misfit over its limit; above one something of the pose is to be left out. `t` as in
  /// PoseResiduals, one pose.
  [[nodiscard]] double excess(const Observations& t) const;
};

/// Judges poses against a fixed block that stays as it is.
class PoseBlame {
 public:
  /// Keeps references. Every observation of `problem` has its weight, none is left out.
  PoseBlame(const JointProblem& problem, const JointState& state, const BlameLimits& limits);
  /// What to leave out of pose k. Tried in this order: nothing, one reading or the scalar reference, a whole
  /// sensor, two readings, all readings. An attitude is judged by itself. `strictness` multiplies the limits.
  [[nodiscard]] Rows of(std::size_t k, double strictness = 1);

 private:
  struct Trial {
    Observations t;
    double chi2{0};
    Nuisance nuisance;
  };
  [[nodiscard]] Trial without(const Rows& out);
  [[nodiscard]] Rows readings_of(double limit);

  JointProblem alone_;  ///< the pose at hand
  JointState at_;
  const JointProblem& problem_;
  const JointState& state_;
  const BlameLimits& limits_;
  PoseModel model_;
  PoseBlocks blocks_;
  JointPose whole_;  ///< the pose at hand with everything in, weights in spreads
};

}  // namespace mgtd::calib::fit::joint
