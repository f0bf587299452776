// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "tests/blind/real_kind.h"

/// Kinds of run that are special in their noise or in their design, and in nothing else.
namespace mgtd::calib::testing {

[[nodiscard]] std::vector<RealKind> noise_kinds();
[[nodiscard]] std::vector<RealKind> design_kinds();

}  // namespace mgtd::calib::testing
