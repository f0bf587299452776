// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "calib/criticism/tests/comparison.h"

namespace mgtd::calib {

/// "mgt.compare/1".
[[nodiscard]] nlohmann::json to_json(const Comparison& comparison);
/// Which covariates stand for others, a sentence for each.
[[nodiscard]] std::vector<std::string> alike_text(const Comparison& comparison);
/// For the terminal: the noise, then each channel against each covariate with a small plot of its means.
[[nodiscard]] std::string to_text(const Comparison& comparison);

}  // namespace mgtd::calib
