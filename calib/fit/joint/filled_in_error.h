// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/fit/joint/joint_fit.h"

/// filled_in_error() is what the total fields that were filled in, from a reference elsewhere or as a known
/// field, add to the covariance of the fixed block. Their common error D moves the solution by S^-1 dg/dD,
/// whatever else is wrong, so this is added after every factor that widens the rest.
namespace mgtd::calib::fit::joint {

/// `reduced` belongs to the problem and the state of the fit. Zero where nothing was filled in.
[[nodiscard]] Eigen::MatrixXd filled_in_error(const JointFit& fit, const Reduced& reduced);

}  // namespace mgtd::calib::fit::joint
