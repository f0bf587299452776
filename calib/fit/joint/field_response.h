// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>

#include "calib/sensor/sensor_model.h"
#include "proto/per_sensor.h"

namespace mgtd::calib::fit::joint {

/// A FieldResponse says how the corrected field of a sensor changes when its 12 parameters change by dp: by
/// -gain by_parameters dp in the platform frame, gain = R (C A)^-1.
struct FieldResponse {
  Eigen::Matrix3d gain;                                               ///< of a change of the reading
  Eigen::Matrix<double, 3, sensor::kSensorParameters> by_parameters;  ///< dy/dp, nT for each unit of p
};

/// Of every sensor in a field of strength F along +X, -X, +Y, -Y, +Z and -Z of the platform. The response is
/// linear in the field, so the mean of its square over these six is that over the sphere, exactly.
[[nodiscard]] std::array<PerSensor<FieldResponse>, 6> field_responses(
    const PerSensor<sensor::SensorModel>& sensors, double f_nT);

}  // namespace mgtd::calib::fit::joint
