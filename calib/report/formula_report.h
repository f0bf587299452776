// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/criticism/tests/collinearity.h"

/// These functions write the examination of a user's formula as a JSON object and as text for a person.
namespace mgtd::calib::report {

[[nodiscard]] nlohmann::json to_json(const criticism::tests::FormulaExamination& x);
[[nodiscard]] std::string to_text(const criticism::tests::FormulaExamination& x);

}  // namespace mgtd::calib::report
