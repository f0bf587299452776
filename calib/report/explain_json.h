// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "calib/criticism/search/explain_report.h"

namespace mgtd::calib::report {

/// to_json() writes what explain() found as JSON (mgt.explain/1).
[[nodiscard]] nlohmann::json to_json(const criticism::search::ExplainReport& report);
[[nodiscard]] nlohmann::json to_json(const criticism::tests::Candidate& candidate);
[[nodiscard]] nlohmann::json to_json(const criticism::tests::ConfusionMatrix& confusion);
[[nodiscard]] nlohmann::json to_json(const criticism::tests::MapScore& map);
[[nodiscard]] nlohmann::json to_json(const criticism::tests::NoiseModel& noise);

}  // namespace mgtd::calib::report
