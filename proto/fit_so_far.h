// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>

namespace mgtd {

/// What a fit of the poses measured so far says beside the accuracy of the tensor: its residual, and of each
/// kind of parameter the largest standard deviation over all sensors. NaN: not known.
struct FitSoFar {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double residual_nT{kUnknown};  ///< reading less prediction, per degree of freedom
  double offset_sd_nT{kUnknown};
  double scale_sd{kUnknown};      ///< relative
  double angle_sd_rad{kUnknown};  ///< of non-orthogonality and alignment
};

}  // namespace mgtd
