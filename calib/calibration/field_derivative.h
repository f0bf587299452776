// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/sensor/sensor_model.h"

/// field_derivative() says how a corrected field changes with errors of the parameters of its sensor.
namespace mgtd::calib::calibration {

/// Axes (columns, platform frame) about which the corrected field turns, as w x b, per unit alpha, beta,
/// gamma: -(Az Ay x, Az y, z). A passive rotation by a about e: d/da (A v) = -(e x A v).
[[nodiscard]] Eigen::Matrix3d turn_axes(const sensor::SensorModel& sensor);

using FieldDerivative = Eigen::Matrix<double, 3, sensor::kSensorParameters>;
/// d(b_P)/d(parameters) with the reading held: b_P = R (CA)^-1 (y - I) gives
///     -R (CA)^-1 d(CA) R' b - R (CA)^-1 dI + dR R' b,   at the corrected field b.
[[nodiscard]] FieldDerivative field_derivative(const sensor::SensorModel& sensor,
                                               const Eigen::Vector3d& b_P_nT);

}  // namespace mgtd::calib::calibration
