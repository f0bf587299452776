// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <string_view>

/// These user-supplied columns say where on Earth the array stood; they are kept with the poses and never
/// fitted. They are no cause of a residual, so no test looks at them; a formula that names one may use it.
namespace mgtd::calib::poses {

inline constexpr std::array<std::string_view, 3> kNeverFitted{"lat_deg", "lon_deg", "h_ellipsoid_m"};

[[nodiscard]] inline bool never_fitted(std::string_view column) {
  return std::find(kNeverFitted.begin(), kNeverFitted.end(), column) != kNeverFitted.end();
}

}  // namespace mgtd::calib::poses
