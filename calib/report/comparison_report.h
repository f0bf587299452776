// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "calib/criticism/tests/comparison.h"
#include "calib/report/seen_width.h"

namespace mgtd::calib::report {

/// to_json() writes the comparison of model and measurement as JSON (mgt.compare/1).
[[nodiscard]] nlohmann::json to_json(const criticism::tests::Comparison& comparison);
/// Which covariates stand for others, a sentence for each.
[[nodiscard]] std::vector<std::string> alike_text(const criticism::tests::Comparison& comparison);
/// For the terminal: the noise, then each channel against each covariate with a small plot of its means.
[[nodiscard]] std::string to_text(const criticism::tests::Comparison& comparison,
                                  std::size_t width = kAnyWidth);

}  // namespace mgtd::calib::report
