// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/rig/effect.h"

/// The truth is what the sensors really are: the parameters of the paper's tables, in the units of those
/// tables.
namespace mgtd::rig {

struct SensorTruth {
  double theta_deg{0}, phi_deg{0}, psi_deg{0};
  Eigen::Vector3d scale{1, 1, 1};
  Eigen::Vector3d offset_nT{0, 0, 0};
  double alpha_deg{0}, beta_deg{0}, gamma_deg{0};
  /// Signed permutation, a column per sensor axis: where it points on the platform. Determinant -1: mirrored.
  Eigen::Matrix3d mounting{Eigen::Matrix3d::Identity()};

  /// y = M b + offset, b the field at the sensor in the platform frame (eqs. 5 and 13-14, written out for the
  /// rig): M = C A R', R = Rz(gamma) Ry(beta) Rx(alpha) mounting.
  [[nodiscard]] Eigen::Matrix3d matrix() const;
};

using RigTruth = std::vector<SensorTruth>;

/// "table3" (the paper's simulation), "table6" (its experiment, first site), "ideal", or "random" (drawn from
/// the seed: scales within 5 %, angles within 3 degrees, offsets within 400 nT; one sensor after the other,
/// so that the first four are the same in every array). The two tables are of four sensors: nothing for any
/// other number.
[[nodiscard]] std::optional<RigTruth> rig_named(std::string_view name, std::uint64_t seed,
                                                std::size_t sensors = kCross);
/// Whether these parameters exist for the cross only.
[[nodiscard]] bool of_the_cross(std::string_view name);

/// The twelve parameters under the names of the results: theta_deg .. psi_deg, cx .. cz, ix_nT .. iz_nT,
/// alpha_deg .. gamma_deg.
[[nodiscard]] std::array<std::pair<const char*, double*>, 12> named_parameters(SensorTruth& truth);

/// "y -x z": the sensor's x axis along the platform's y, its y against the platform's x, z along z.
[[nodiscard]] std::optional<Eigen::Matrix3d> parse_mounting(std::string_view text);
[[nodiscard]] std::string mounting_text(const Eigen::Matrix3d& mounting);

}  // namespace mgtd::rig
