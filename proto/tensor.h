// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>

#include "proto/flags.h"
#include "proto/time.h"

/// A TensorSample is the field and its gradient at the centre of the cross, in the platform frame.
namespace mgtd {

/// The six components in the order of the stream: xx, yy, zz, xy, xz, yz. Symmetric and traceless by
/// construction: zz = -(xx + yy); G(i,j) = dB_i/dx_j.
struct Gradient {
  double xx{0}, yy{0}, zz{0}, xy{0}, xz{0}, yz{0};
};

/// Four quantities that vanish for a uniform field plus a constant source-free gradient (method, section 1).
struct Closure {
  double curl_nT_per_m{0};                             ///< Bxy - Byx
  Eigen::Vector3d center_nT{Eigen::Vector3d::Zero()};  ///< (B1+B3)/2 - (B2+B4)/2
  double chi2{0};  ///< of the four, 4 degrees of freedom; NaN when no noise is known
};

struct TensorSample {
  std::uint64_t seq{0};
  Stamp t;
  std::shared_ptr<const std::string> calibration_id;  ///< null: uncalibrated
  Eigen::Vector3d b_P_nT{Eigen::Vector3d::Zero()};
  double f_nT{0};
  Gradient g_nT_per_m;
  Gradient g_sd_nT_per_m;  ///< noise and calibration together; NaN when unknown
  Closure closure;
  double skew_bound_s{0};
  Flags flags;
};

}  // namespace mgtd
