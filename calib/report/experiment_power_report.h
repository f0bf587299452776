// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/design/experiment_power.h"

/// These functions write the part of a design's report that is about missing effects: keys
/// "detectable_above", "inseparable", "pairs" and "untestable" of "mgt.plan/1", and their tables for a
/// person.
namespace mgtd::calib::report {

void add_json(const design::DesignPower& power, nlohmann::json& report);
[[nodiscard]] std::string to_text(const design::DesignPower& power);

}  // namespace mgtd::calib::report
