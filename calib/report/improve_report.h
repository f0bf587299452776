// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/criticism/search/improve.h"
#include "calib/report/seen_width.h"

namespace mgtd::calib::report {

/// to_json() writes what improve() did as JSON (mgt.improve/1).
[[nodiscard]] nlohmann::json to_json(const criticism::search::ImproveReport& report);
[[nodiscard]] std::string to_text(const criticism::search::ImproveReport& report,
                                  std::size_t width = kAnyWidth);

}  // namespace mgtd::calib::report
