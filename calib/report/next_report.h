// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/criticism/search/next_pair.h"

/// These functions write the next measurement as JSON (mgt.next/1) and as text for a person.
namespace mgtd::calib::report {

[[nodiscard]] nlohmann::json to_json(const criticism::search::NextReport& report);
[[nodiscard]] std::string to_text(const criticism::search::NextReport& report);

/// The poses of a step as CSV: attitude, approach and dwell, in the columns of a pose table, without
/// readings. Where a hand is needed, `note` of the first says for what.
[[nodiscard]] std::string pose_list(const criticism::search::NextStep& step);

}  // namespace mgtd::calib::report
