// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/validity/diff.h"

/// The difference of two calibrations in sentences.
namespace mgtd::calib {

/// What changed, or that nothing did.
[[nodiscard]] std::string conclusion_text(const DiffReport& report);
/// Effects that only one calibration has, remounted sensors, a free scale, the turn of the whole array.
[[nodiscard]] std::vector<std::string> remarks_of(const DiffReport& report);

}  // namespace mgtd::calib
