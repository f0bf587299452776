// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "calib/criticism/search/explain_report.h"

namespace mgtd::calib {

/// "mgt.explain/1".
[[nodiscard]] nlohmann::json to_json(const ExplainReport& report);
[[nodiscard]] nlohmann::json to_json(const MapScore& map);
[[nodiscard]] nlohmann::json to_json(const NoiseModel& noise);

}  // namespace mgtd::calib
