// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>

#include "calib/sensor/geometry.h"
#include "calib/sensor/sensor_model.h"
#include "proto/tensor.h"

namespace mgtd::calib::fit::joint {

/// Standard deviation that a covariance of the 48 parameters gives each component of the tensor in a uniform
/// field of strength F: root mean square over all attitudes. An error of the parameters shifts the corrected
/// field of a sensor by -R (C A)^-1 dy/dp dp, linear in the field, so the mean over the sphere is that over
/// six directions, exactly.
[[nodiscard]] Gradient calibration_tensor_sd(const PerSensor<sensor::SensorModel>& sensors,
                                             const sensor::Geometry& geometry,
                                             const Eigen::MatrixXd& covariance, double f_nT);

}  // namespace mgtd::calib::fit::joint
