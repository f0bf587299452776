// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/discovery/fitted_law.h"

/// The table's angles have errors, so what a law of these angles adds to a reading scatters from pose to pose
/// as if the reading itself were noisier. variance_of_angles() computes the variance that this adds:
///
///     var_c(k) = sum over azimuth, pitch, roll of ((f_c(angle + sd) - f_c(angle - sd)) / 2)^2
///
/// Not said of temperatures, time and recorded columns: a run does not tell how good those are.
namespace mgtd::calib::discovery {

/// nT^2, poses x channels of the readings; `sd_rad` of each angle. Refuses what is no expression.
[[nodiscard]] Result<Eigen::MatrixXd> variance_of_angles(const FittedLaw& law, double sd_rad,
                                                         LawInputs& inputs);

/// The fit with the weights that readings have beside that variance; nuisances are fitted again.
[[nodiscard]] fit::joint::JointFit beside_variance(fit::joint::JointFit fit,
                                                   const Eigen::MatrixXd& variance_nT2);

}  // namespace mgtd::calib::discovery
