// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "tests/blind/real_kind.h"

/// Kinds of run in which something went wrong: readings, disturbances beside the array, mistakes of the
/// set-up.
namespace mgtd::calib::testing {

[[nodiscard]] std::vector<RealKind> wrong_reading_kinds();
[[nodiscard]] std::vector<RealKind> disturbance_kinds();
[[nodiscard]] std::vector<RealKind> mistake_kinds();

}  // namespace mgtd::calib::testing
