// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/criticism/search/choice.h"

namespace mgtd::calib::report {

/// to_text() says what a Choice leaves open, in one or two clauses; it is empty when nothing is open.
[[nodiscard]] std::string to_text(const criticism::search::Choice& choice);

}  // namespace mgtd::calib::report
