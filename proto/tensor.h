// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "proto/flags.h"
#include "proto/per_sensor.h"
#include "proto/time.h"

/// A TensorSample is the field and its gradient at the centre of the array, in the platform frame.
namespace mgtd {

/// The six components in the order of the stream: xx, yy, zz, xy, xz, yz. Symmetric and traceless by
/// construction: zz = -(xx + yy); G(i,j) = dB_i/dx_j. NaN: the array cannot tell this component.
struct Gradient {
  double xx{0}, yy{0}, zz{0}, xy{0}, xz{0}, yz{0};
};
[[nodiscard]] inline std::array<double, 6> components(const Gradient& g) {
  return {g.xx, g.yy, g.zz, g.xy, g.xz, g.yz};
}

/// What of a gradient does not change when the frame is turned (Pedersen and Rasmussen, Geophysics 55, 1990):
///
///     I1 = Gxx Gyy + Gyy Gzz + Gxx Gzz - Gxy^2 - Gyz^2 - Gxz^2      I2 = det G
///     contraction = sqrt(sum over i and j of Gij^2), which is sqrt(-2 I1) of a traceless tensor
struct Invariants {
  double I1_nT2_per_m2{0}, I2_nT3_per_m3{0}, contraction_nT_per_m{0};
};
/// Empty where the array cannot tell all components.
[[nodiscard]] std::optional<Invariants> invariants(const Gradient& g);

/// Quantities that vanish for a uniform field plus a constant source-free gradient (method, section 1). The
/// cross has four of them, by name; another array of N sensors has 3N less the number of components that it
/// can tell, as independent combinations of its readings (FieldExpansion::closure_rows).
struct Closure {
  double curl_nT_per_m{0};                             ///< of the cross: Bxy - Byx
  Eigen::Vector3d center_nT{Eigen::Vector3d::Zero()};  ///< of the cross: (B1+B3)/2 - (B2+B4)/2
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3 * kMostSensors, 1>
      combinations_nT{};  ///< of another array; empty for the cross
  double chi2{0};         ///< of all of them; NaN when no noise is known, and where there are none
  int dof{4};             ///< how many there are
};

/// Derivative of the field along the line on which the sensors stand, dB/du = G u, u the line's direction
/// (ArrayDescription::line): all that sensors on one line tell of the gradient.
struct LineDerivative {
  Eigen::Vector3d nT_per_m, sd_nT_per_m;  ///< sd: noise and calibration together; NaN when unknown
};

struct TensorSample {
  std::uint64_t seq{0};
  Stamp t;
  std::shared_ptr<const std::string> calibration_id;  ///< null: uncalibrated
  Eigen::Vector3d b_P_nT{Eigen::Vector3d::Zero()};
  double f_nT{0};
  Gradient g_nT_per_m;
  Gradient g_sd_nT_per_m;                      ///< noise and calibration together; NaN when unknown
  std::optional<LineDerivative> along_line{};  ///< of sensors on one line
  Closure closure;
  double skew_bound_s{0};
  Flags flags;
};

}  // namespace mgtd
