// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/sensor/step1.h"

namespace mgtd::calib::sensor {

/// sensor_start() makes a first guess of the parameters of one sensor alone, whatever the rig: step 1 where
/// it holds, else (condition, a quadric that is no ellipsoid, disturbed poses) the best sphere, which is
/// linear, needs no sign and has no limit on the offset. It is a start, not an estimate. Refuses too few
/// readings and readings on a plane.
[[nodiscard]] Result<ScalarCalibration> sensor_start(const Eigen::Matrix3Xd& y_nT,
                                                     const Eigen::VectorXd& f_nT);

}  // namespace mgtd::calib::sensor
