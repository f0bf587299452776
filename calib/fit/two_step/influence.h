// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/two_step/two_step.h"

/// influence() computes the uncertainty of the two-step estimate, to first order (delta method): it follows
/// the influence of every single observation on every parameter through both steps.
///
///   step 1     dp_i  = -(J'J)^-1 sum_k J_k' (n' G dy_k - dF_k),   J = n' d(b)/d(p), n = b/|b|, G = R (CA)^-1
///   field      db_ik = G dy_ik + D_ik dp_i + (dT_k/dangles) B dangles_k,   relative to F_k in step 2
///   step 2     w_i   = -1/2 sum_k m_ik x db_ik,   m_ik = (sum_k b b')^-1 b_ik   nearest rotation, dR = w x R
///   azimuth    origin from the tilted poses, from the operator (exact), or from the mean of gamma
///
/// Independent errors: every reading (noise of a pose mean per axis), every scalar reading, every table angle
/// of every pose. The table's errors are common to the four sensors, so are those of F: the covariance says
/// so. A field given by the operator is one error common to all poses. Not covered: the bias of the
/// simplified method, effects that are not in the model, errors of a given declination.
namespace mgtd::calib::fit::two_step {

struct Influence {
  Eigen::MatrixXd covariance;  ///< of the parameters
  double inclination_sd_rad{0}, declination_sd_rad{0};
};

/// `pose_noise_nT`: standard deviation of a pose mean, per axis.
[[nodiscard]] Influence influence(const Readings& readings, const FitOptions& options, const TwoStep& fitted,
                                  const calibration::AxisNoise& pose_noise_nT);

}  // namespace mgtd::calib::fit::two_step
