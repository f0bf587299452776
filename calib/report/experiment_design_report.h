// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/design/experiment_design.h"
#include "calib/report/seen_width.h"

/// These functions write the report of an experiment design as JSON (mgt.plan/1) and as text.
namespace mgtd::calib::report {

[[nodiscard]] nlohmann::json to_json(const design::DesignReport& report);
[[nodiscard]] std::string to_text(const design::DesignReport& report, std::size_t width = kAnyWidth);

}  // namespace mgtd::calib::report
