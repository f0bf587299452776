// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration/calibration.h"
#include "calib/fit/joint/joint_solver.h"

/// PoseResiduals holds what the residuals of a solved joint problem say about its noise and its table.
namespace mgtd::calib::fit::joint {

/// Observations of one pose in whitened units: the readings, the scalar reference, the attitude.
inline constexpr int kMostObservations = sensor::kMostChannels + 2;
/// Misfits of one pose.
using Observations = Eigen::Array<double, Eigen::Dynamic, 1, 0, kMostObservations, 1>;

struct PoseResiduals {
  /// |residual| over its own standard deviation, by observation and pose; 0 where left out.
  Eigen::MatrixXf t;
  calibration::AxisNoise noise_ratio;  ///< rms residual over assumed noise, per axis, freedom accounted for
  double table_ratio{1};               ///< the same of the attitude errors
  double attitude_freedom{0};          ///< observations of attitude less what was fitted to them
  int readings{0}, scalars{0};

  double squares_nT2{0};  ///< of reading less prediction, summed over all readings
  double freedom{0};      ///< of those readings, less what each pose's own attitude and field took
  double fitted{0};       ///< unknowns of the fixed block that the readings had to tell

  [[nodiscard]] Eigen::Index scalar_row() const { return t.rows() - 2; }
  [[nodiscard]] Eigen::Index attitude_row() const { return t.rows() - 1; }
  [[nodiscard]] Observations of_pose(Eigen::Index k) const { return t.col(k).cast<double>().array(); }
  /// What "residual" means in every report: the root of the mean square of reading less prediction, nT, over
  /// the readings of all channels, each pose with its own best attitude and field; per degree of freedom, so
  /// that it is the noise of a pose mean where the model is complete.
  [[nodiscard]] double residual_nT() const;
  /// The same on poses that the fixed block was not fitted to.
  [[nodiscard]] double unseen_nT() const;
};

[[nodiscard]] PoseResiduals pose_residuals(const JointProblem& problem, const JointState& state);

}  // namespace mgtd::calib::fit::joint
