// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/orientation.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mgtd::calib::fit {

Eigen::Vector3d angles_of(const Eigen::Matrix3d& A) {
  return {std::atan2(-A(2, 1), A(2, 2)), std::asin(std::clamp(A(2, 0), -1.0, 1.0)),
          std::atan2(-A(1, 0), A(0, 0))};
}

Eigen::Matrix3d nearest_signed_permutation(const Eigen::Matrix3d& R) {
  constexpr std::array<std::array<int, 3>, 6> kRows{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  double best_trace = -1;
  for (const auto& rows : kRows) {
    Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
    for (int j = 0; j < 3; ++j) {
      const int i = rows[static_cast<std::size_t>(j)];
      m(i, j) = R(i, j) < 0 ? -1 : 1;
    }
    const double trace = m.cwiseProduct(R).sum();
    if (trace > best_trace) {
      best_trace = trace;
      best = m;
    }
  }
  return best;
}

Eigen::Matrix3d nearest_orthogonal(const Eigen::Matrix3d& H, bool proper) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d d = Eigen::Vector3d::Ones();
  if (proper) d[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * d.asDiagonal() * svd.matrixV().transpose();
}

Eigen::Vector3d direction_of_sphere(int i, int n) {
  const double z = 1 - (2 * i + 1.0) / n, turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
  const double h = std::sqrt(1 - z * z);
  return {h * std::cos(turn), h * std::sin(turn), z};
}

sensor::SensorModel sensor_from(const Eigen::Matrix3d& K, const Eigen::Vector3d& offset_nT,
                                const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d M = K.inverse();  // C A, upper triangular
  sensor::SensorModel s;
  s.scale = {M.row(0).norm(), M.row(1).norm(), M(2, 2)};
  s.theta_rad = std::atan2(M(0, 1), M(0, 0));
  s.phi_rad = std::atan2(M(0, 2), std::hypot(M(0, 0), M(0, 1)));
  s.psi_rad = std::atan2(M(1, 2), M(1, 1));
  s.offset_nT = offset_nT;
  s.mounting = nearest_signed_permutation(R);
  const Eigen::Vector3d a = angles_of(R * s.mounting.transpose());
  s.alpha_rad = a[0];
  s.beta_rad = a[1];
  s.gamma_rad = a[2];
  return s;
}

sensor::SensorModel turned(const sensor::SensorModel& sensor, const Eigen::Matrix3d& Q) {
  return sensor_from(sensor.response().inverse(), sensor.offset_nT, Q * sensor.R_PS());
}

}  // namespace mgtd::calib::fit
