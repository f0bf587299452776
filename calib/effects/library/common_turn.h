// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/effects/effect.h"

namespace mgtd::calib::effects::library {

/// turn_of_first_sensor() says how the coefficients of an effect that can turn all sensors turn sensor s1: to
/// first order, about its axis k by the sum over coefficients of row(k) times them. The matrix is
/// 3 x coefficients.
///
///     axis.orthogonality.temperature, ...2    (chi_cb - chi_bc) / 2, k b c in cyclic order
///     platform.thermal-bending                w_k, where there is another sensor
///
/// Where nothing but the readings tells the attitude, a turn that all sensors make together is one of the
/// array, and these data do not show it: only how the others turn against s1. No rows for any other effect,
/// and where one of the sensors has no coefficients of its own.
[[nodiscard]] Eigen::MatrixXd turn_of_first_sensor(const Effect& effect, int sensors);

}  // namespace mgtd::calib::effects::library
