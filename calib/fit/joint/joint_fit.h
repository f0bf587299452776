// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "calib/fit/fit_summary.h"
#include "calib/fit/joint/joint_setup.h"
#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/joint/outliers.h"
#include "calib/fit/quantisation.h"

/// fit_joint() fits all sensors together by maximum likelihood over all poses (method, section 5).
///
/// Noise: from the spreads within the dwells where every pose has them, else from the residuals, iterated;
/// pooled per axis either way. The standard deviation of the table angles is estimated. Observations that all
/// others contradict become outlier nodes (outliers.h); where some do, the fit starts anew from the poses
/// that agree with each other (consensus.h), so that up to a third of gross poses of any size hide nothing.
/// Trivial solutions cannot win: residuals are those of raw readings, in nT, and a sensor whose gain
/// collapses or explodes is refused by its determinant. Does not decide whether a calibration is acceptable.
namespace mgtd::calib::fit::joint {

struct JointFit {
  JointProblem problem;  ///< final weights; points into the pose table
  JointState state;
  /// Of the fixed block, gauge constraints included; the noise of the readings inflated by `birge_ratio`.
  Eigen::MatrixXd covariance;
  calibration::AxisNoise pose_noise_nT{calibration::AxisNoise::Zero(kSensors, 3)};
  std::optional<calibration::AxisNoise> sample_noise_nT;  ///< set when the weights come from the dwells
  Quantisation quantisation;                              ///< in the weights, where they come from the dwells
  double noise_inflation{1};  ///< JointOptions::noise_inflation: in the weights, not in what follows
  double table_sd_rad{0};     ///< estimated; 0 without angles
  double chi2{0}, dof{0};     ///< readings and scalar reference
  double chi2_table{0}, dof_table{0};
  /// Of a recording of single samples: how many of them count as one (sample_correlation.h). In the
  /// covariance.
  double samples_per_effective{1};
  double birge_ratio{1};  ///< sqrt(chi2/dof) where significantly above one, else 1
  Termination termination{Termination::converged};
  int rounds{0}, iterations{0};  ///< FitSummary
  JointState start;              ///< where the solver began
  Gauge gauge;
  /// Standard deviations of the mean alpha, beta and gamma of all sensors.
  std::array<double, 3> common_rotation_sd_rad{};
  std::vector<OutlierNode> outliers;
  /// Poses that contradict the others in something, of all poses; above a third of them nothing is left out.
  double contradicting{0};

  [[nodiscard]] double noise_nT() const;  ///< rms of a pose mean over the axes
};

/// Poses that a fit needs; in general position, and better sixty.
inline constexpr std::size_t kFewestPoses = 12;

[[nodiscard]] Result<JointFit> fit_joint(const PoseTable& table, const JointOptions& options);
/// The same with a warm start (another fold, the run before the last pose). Nuisances are refitted.
[[nodiscard]] Result<JointFit> fit_joint(const PoseTable& table, const JointOptions& options,
                                         const JointState& warm_start);

/// With JointOptions::noise_inflation as large as the residual asks for; 1 where the model is not far off.
/// `warm_start` may be null.
[[nodiscard]] Result<JointFit> fit_joint_at_size(const PoseTable& table, const JointOptions& options,
                                                 const JointState* warm_start = nullptr);

/// JointFit::covariance of a fit whose other members are set; `reduced` at its state and weights.
[[nodiscard]] Result<Eigen::MatrixXd> covariance_of(const JointFit& fit, const Reduced& reduced);
/// (S)^-1 of the information of the fixed block; refuses when it is not positive definite.
[[nodiscard]] Result<Eigen::MatrixXd> covariance_of(const Eigen::MatrixXd& S);

}  // namespace mgtd::calib::fit::joint
