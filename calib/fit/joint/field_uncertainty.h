// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/sensor/sensor_model.h"
#include "proto/per_sensor.h"

namespace mgtd::calib::fit::joint {

/// calibration_field_sd_nT() gives the standard deviation of a component of the corrected field, in nT, that
/// follows from a covariance of the parameters (12 a sensor, s1 first): root mean square over sensors,
/// components and all attitudes of a field of strength F. It is to arrays that see no gradient what
/// calibration_tensor_sd (tensor_uncertainty.h) is to others.
[[nodiscard]] double calibration_field_sd_nT(const PerSensor<sensor::SensorModel>& sensors,
                                             const Eigen::MatrixXd& covariance, double f_nT);

}  // namespace mgtd::calib::fit::joint
