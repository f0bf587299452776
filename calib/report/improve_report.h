// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/criticism/search/improve.h"

namespace mgtd::calib {

/// "mgt.improve/1".
[[nodiscard]] nlohmann::json to_json(const ImproveReport& report);
[[nodiscard]] std::string to_text(const ImproveReport& report);

}  // namespace mgtd::calib
