// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/fit/joint/joint_setup.h"
#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/joint/outliers.h"
#include "calib/fit/quantisation.h"

/// Joint maximum likelihood over all poses and sensors (method, section 5).
///
/// Noise: from the spreads within the dwells where every pose has them, else from the residuals, iterated;
/// pooled per axis either way. The standard deviation of the table angles is estimated. Observations that the
/// rest contradicts become outlier nodes (outliers.h); where some do, the fit starts anew from the poses that
/// agree with each other (consensus.h), so that up to a third of gross poses of any size hide nothing.
/// Trivial solutions cannot win: residuals are those of raw readings, in nT, and a sensor whose gain
/// collapses or explodes is refused by its determinant. Does not decide whether a calibration is acceptable.
namespace mgtd::calib {

/// Stands in the gauge's text of a fit that knew no field.
inline constexpr std::string_view kScaleIsFree = "the overall scale is free";

struct JointFit {
  JointProblem problem;  ///< final weights; points into the pose table
  JointState state;
  /// Of the fixed block, gauge constraints included; readings taken as worse by `spread`.
  Eigen::MatrixXd covariance;
  AxisNoise pose_noise_nT{AxisNoise::Zero()};
  std::optional<AxisNoise> sample_noise_nT;  ///< set when the weights come from the dwells
  Quantisation quantisation;                 ///< in the weights, where they come from the dwells
  double worse{1};                           ///< JointOptions::worse: in the weights, not in what follows
  double table_sd_rad{0};                    ///< estimated; 0 without angles
  double chi2{0}, dof{0};                    ///< readings and scalar reference
  double chi2_table{0}, dof_table{0};
  double spread{1};  ///< sqrt(chi2/dof) where significantly above one, else 1
  int iterations{0};
  Gauge gauge;
  std::string gauge_text;
  std::vector<OutlierNode> outliers;
  /// Poses that contradict the others in something, of all poses; above a third of them nothing is left out.
  double contradicting{0};

  [[nodiscard]] double noise_nT() const;  ///< rms of a pose mean over the axes
};

/// Poses that a fit needs; in general position, and better sixty.
inline constexpr std::size_t kFewestPoses = 12;

[[nodiscard]] Result<JointFit> fit_joint(const PoseTable& table, const JointOptions& options);
/// The same from a state that is already near (another fold, the run before the last pose). Nuisances are
/// refitted.
[[nodiscard]] Result<JointFit> fit_joint(const PoseTable& table, const JointOptions& options,
                                         const JointState& near);

/// With JointOptions::worse as large as the residual asks for; 1 where the model is not far off. `near` may
/// be null.
[[nodiscard]] Result<JointFit> fit_joint_at_size(const PoseTable& table, const JointOptions& options,
                                                 const JointState* near = nullptr);

/// (S)^-1 of the information of the fixed block; refuses when it is not positive definite.
[[nodiscard]] Result<Eigen::MatrixXd> covariance_of(const Eigen::MatrixXd& S);

}  // namespace mgtd::calib
