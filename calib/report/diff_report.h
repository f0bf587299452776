// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/validity/diff.h"

/// These functions say in sentences how two calibrations differ.
namespace mgtd::calib::report {

/// What changed, or that nothing did.
[[nodiscard]] std::string conclusion_text(const validity::DiffReport& report);
/// Effects that only one calibration has, remounted sensors, a free scale, the turn of the whole array.
[[nodiscard]] std::vector<std::string> remarks_of(const validity::DiffReport& report);

}  // namespace mgtd::calib::report
