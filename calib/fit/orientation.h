// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/sensor/sensor_model.h"

/// These functions find the parameters of a sensor from matrices.
namespace mgtd::calib::fit {

/// alpha, beta, gamma of A_gamma A_beta A_alpha (eqs. 13-14); beta within 90 degrees.
[[nodiscard]] Eigen::Vector3d angles_of(const Eigen::Matrix3d& A);

/// The nearest of the 48 signed permutations to an orthogonal matrix.
[[nodiscard]] Eigen::Matrix3d nearest_signed_permutation(const Eigen::Matrix3d& R);

/// Orthogonal matrix nearest to H; det = +1 when `proper`.
[[nodiscard]] Eigen::Matrix3d nearest_orthogonal(const Eigen::Matrix3d& H, bool proper);

/// The i-th of n directions spread evenly over the sphere (Fibonacci).
[[nodiscard]] Eigen::Vector3d direction_of_sphere(int i, int n);

/// The sensor with b_P = R K (y - offset): K upper triangular with positive diagonal, R orthogonal (det -1:
/// mirrored).
[[nodiscard]] sensor::SensorModel sensor_from(const Eigen::Matrix3d& K, const Eigen::Vector3d& offset_nT,
                                              const Eigen::Matrix3d& R);

/// The same sensor with the platform frame turned by Q: R becomes Q R, the mounting is found anew.
[[nodiscard]] sensor::SensorModel turned(const sensor::SensorModel& sensor, const Eigen::Matrix3d& Q);

}  // namespace mgtd::calib::fit
