// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/sensor/sensor_model.h"
#include "proto/per_sensor.h"

namespace mgtd::calib::fit::joint {

/// Standard deviation in nT that a covariance of the parameters (12 a sensor, s1 first) gives a component of
/// the corrected field: root mean square over sensors, components and all attitudes of a field of strength F.
/// As calibration_tensor_sd (tensor_uncertainty.h), for arrays that see no gradient.
[[nodiscard]] double calibration_field_sd_nT(const PerSensor<sensor::SensorModel>& sensors,
                                             const Eigen::MatrixXd& covariance, double f_nT);

}  // namespace mgtd::calib::fit::joint
