// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <string_view>

/// A SensorModel describes one three-axis fluxgate of the array by twelve parameters and a mounting.
///
///     y   = C A b_S + I        C = diag(cx, cy, cz), I = (ix, iy, iz), A upper triangular in        (eq. 5)
///                              theta, phi, psi
///     b_P = R_PS b_S           R_PS = A_gamma A_beta A_alpha M                                 (eqs. 13-14)
///
///   y    3x1 nT   reading at nominal scale, no frame
///   b_S  3x1 nT   field in the sensor's ideal orthogonal frame S
///   b_P  3x1 nT   field at the sensor in the platform frame P
///   M             mounting, a signed permutation: the nearest of the 48 right- and left-handed axis
///                 orientations, so that alpha, beta, gamma stay small and no orientation is a singularity.
///                 Identity on an upright sensor.
///
/// Li Qingzhu et al., "Two-step linear calibration of planar cross magnetic gradient tensor system". Does not
/// model temperature, hysteresis, nonlinearity or neighbours' fields.
namespace mgtd::calib::sensor {

inline constexpr int kSensorParameters = 12;
/// Order of the parameters wherever they stand in a vector.
enum Parameter : int { theta, phi, psi, cx, cy, cz, ix, iy, iz, alpha, beta, gamma };
inline constexpr std::array<std::string_view, kSensorParameters> kParameterNames{
    "theta", "phi", "psi", "cx", "cy", "cz", "ix", "iy", "iz", "alpha", "beta", "gamma"};

using ParameterVector = Eigen::Matrix<double, kSensorParameters, 1>;

struct SensorModel {
  double theta_rad{0}, phi_rad{0}, psi_rad{0};
  Eigen::Vector3d scale{Eigen::Vector3d::Ones()};
  Eigen::Vector3d offset_nT{Eigen::Vector3d::Zero()};
  double alpha_rad{0}, beta_rad{0}, gamma_rad{0};
  Eigen::Matrix3d mounting{Eigen::Matrix3d::Identity()};

  /// C A: ideal orthogonal field to reading less offset. Upper triangular.
  [[nodiscard]] Eigen::Matrix3d response() const;
  /// R_PS: sensor frame to platform frame. Orthogonal; determinant -1 for a mirrored sensor.
  [[nodiscard]] Eigen::Matrix3d R_PS() const;
  [[nodiscard]] Eigen::Vector3d predict(const Eigen::Vector3d& b_P_nT) const;
  /// Exact inverse of predict.
  [[nodiscard]] Eigen::Vector3d correct(const Eigen::Vector3d& y_nT) const;

  [[nodiscard]] ParameterVector parameters() const;
  [[nodiscard]] static SensorModel from_parameters(
      const ParameterVector& p, const Eigen::Matrix3d& mounting = Eigen::Matrix3d::Identity());
};

/// Passive rotations of eq. 13: the components of a fixed vector after the frame is turned by the angle.
[[nodiscard]] Eigen::Matrix3d rotation_x(double alpha_rad);
[[nodiscard]] Eigen::Matrix3d rotation_y(double beta_rad);
[[nodiscard]] Eigen::Matrix3d rotation_z(double gamma_rad);

}  // namespace mgtd::calib::sensor
