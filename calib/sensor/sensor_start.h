// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/sensor/step1.h"

namespace mgtd::calib {

/// A first guess of one sensor by itself that exists for every rig that can exist: step 1 where it holds,
/// else (condition, a quadric that is no ellipsoid, disturbed poses) the best sphere, which is linear, needs
/// no sign and knows no limit on the offset. A start, not an estimate. Refuses too few readings and readings
/// on a plane.
[[nodiscard]] Result<ScalarCalibration> sensor_start(const Eigen::Matrix3Xd& y_nT,
                                                     const Eigen::VectorXd& f_nT);

}  // namespace mgtd::calib
