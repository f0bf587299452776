// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

/// These words stand beside the same figures in every report.
namespace mgtd::calib::report {

/// What "residual" means: see PoseResiduals.
inline constexpr std::string_view kResidualIs =
    "rms of reading less prediction over all channels, each pose with its own best attitude and field, per "
    "degree of freedom";

/// Where the noise of a pose mean comes from. `known`: from the table of poses.
[[nodiscard]] constexpr std::string_view noise_source(bool known) {
  return known
             ? "from the spread of the samples within the dwells"
             : "estimated from the residual itself: the poses do not tell spread and number of their samples";
}

}  // namespace mgtd::calib::report
