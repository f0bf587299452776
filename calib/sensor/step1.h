// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "proto/error.h"

/// Step 1 calibrates one sensor by itself, from readings in fields of known magnitude (scalar calibration,
/// nine parameters).
namespace mgtd::calib::sensor {

inline constexpr Eigen::Index kFewestScalarPoses = 9;  ///< as many as there are parameters

struct ScalarCalibration {
  /// b_S = K (y - I), upper triangular, positive diagonal (eq. 6).
  Eigen::Matrix3d K{Eigen::Matrix3d::Identity()};
  Eigen::Vector3d offset_nT{Eigen::Vector3d::Zero()};
  double condition{0};  ///< of the nine columns, centred and scaled; some tens for poses in general position

  [[nodiscard]] Eigen::Matrix3Xd correct(const Eigen::Matrix3Xd& y_nT) const {
    return K * (y_nT.colwise() - offset_nT);
  }
};

/// The linear fit of eqs. 7-12 with the constant on the right-hand side:
///     [x y z x^2 y^2 z^2 xy xz yz] w = 1
/// in coordinates centred on the mean reading and scaled by its spread. (With the constant among the unknowns
/// a constant field is fitted exactly by w = 0: the trivial solution. Centred, the right-hand side keeps its
/// sign however large the offset is, because the mean of points on an ellipsoid lies inside it.) Fields that
/// differ from pose to pose are brought to their mean by scaling the reading about the offset, iterated.
/// Normal equations of the scaled columns; the condition decides whether they may be trusted.
///
/// y_nT 3xN, f_nT N. Refuses fewer than nine poses, readings on a plane (poses about one axis), a condition
/// above the limit, and a quadric that is no ellipsoid.
[[nodiscard]] Result<ScalarCalibration> scalar_calibration(const Eigen::Matrix3Xd& y_nT,
                                                           const Eigen::VectorXd& f_nT);

/// The baseline that the method is compared with: small terms of second order dropped,
///     |y|^2 - F^2 ~ 2 y' D y + 2 I' y,   b_S ~ y - D y - I,   D upper triangular.
[[nodiscard]] Result<ScalarCalibration> simplified_calibration(const Eigen::Matrix3Xd& y_nT,
                                                               const Eigen::VectorXd& f_nT);

}  // namespace mgtd::calib::sensor
