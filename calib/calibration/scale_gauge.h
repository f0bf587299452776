// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "calib/calibration/calibration.h"

namespace mgtd::calib::calibration {

/// The text `gauge` of a calibration contains these words when it was fitted without a known field.
inline constexpr std::string_view kScaleIsFree = "the overall scale is free";

/// Whether a calibration knows its scale factors but for one common factor.
[[nodiscard]] inline bool scale_is_free(const Calibration& calibration) {
  return calibration.gauge.find(kScaleIsFree) != std::string::npos;
}

}  // namespace mgtd::calib::calibration
