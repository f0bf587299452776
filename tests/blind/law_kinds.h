// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "tests/blind/real_kind.h"

/// Kinds of run in which laws act: those that the library holds, and those that it does not.
namespace mgtd::calib::testing {

[[nodiscard]] std::vector<RealKind> law_kinds();
[[nodiscard]] std::vector<RealKind> unlisted_kinds();

}  // namespace mgtd::calib::testing
