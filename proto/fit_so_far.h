// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <vector>

namespace mgtd {

/// FitSoFar holds what a fit of the poses measured so far says beside the accuracy of the tensor: its
/// residual, and the standard deviations of the parameters, of each kind the largest over all sensors. NaN:
/// not known.
struct FitSoFar {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double residual_nT{kUnknown};  ///< reading less prediction, per degree of freedom
  double offset_sd_nT{kUnknown};
  double scale_sd{kUnknown};      ///< relative
  double angle_sd_rad{kUnknown};  ///< of non-orthogonality and alignment
  /// Of every parameter, sensor by sensor, in rad, relative and in nT; no elements where not known.
  std::vector<double> parameter_sd{};
};

}  // namespace mgtd
