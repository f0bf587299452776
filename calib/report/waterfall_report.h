// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/criticism/search/waterfall.h"
#include "calib/report/seen_width.h"

namespace mgtd::calib::report {

/// These functions write what each effect of a model takes out of the error (waterfall.h) as JSON and as
/// text.
[[nodiscard]] nlohmann::json to_json(const criticism::search::Waterfall& w);
[[nodiscard]] std::string to_text(const criticism::search::Waterfall& w, std::size_t width = kAnyWidth);

}  // namespace mgtd::calib::report
