// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

/// What the four sensors truly are: the parameters of the paper's tables, in the units of those tables.
namespace mgtd::rig {

struct SensorTruth {
  double theta_deg{0}, phi_deg{0}, psi_deg{0};
  Eigen::Vector3d scale{1, 1, 1};
  Eigen::Vector3d offset_nT{0, 0, 0};
  double alpha_deg{0}, beta_deg{0}, gamma_deg{0};
  Eigen::Matrix3d mounting{Eigen::Matrix3d::Identity()};  ///< signed permutation; determinant -1: mirrored

  /// y = M b + offset, b the field at the sensor in the platform frame (eqs. 5 and 13-14, written out for the
  /// rig).
  [[nodiscard]] Eigen::Matrix3d matrix() const;
};

using RigTruth = std::array<SensorTruth, 4>;

/// "table3" (the paper's simulation), "table6" (its experiment, first site), "ideal", or "random" (drawn from
/// the seed: scales within 5 %, angles within 3 degrees, offsets within 400 nT).
[[nodiscard]] std::optional<RigTruth> rig_named(std::string_view name, std::uint64_t seed);

}  // namespace mgtd::rig
