// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/criticism/search/model_change.h"
#include "calib/report/seen_width.h"

/// These functions write what a change of the model does as a JSON object and as text for a person.
namespace mgtd::calib::report {

/// Schema "mgt.model-change/1".
[[nodiscard]] nlohmann::json to_json(const criticism::search::ModelChange& change);
[[nodiscard]] std::string to_text(const criticism::search::ModelChange& change,
                                  std::size_t width = kAnyWidth);
/// What was measured, against which limit.
[[nodiscard]] std::string to_text(const criticism::search::ModelChange& change, criticism::search::Veto veto);

}  // namespace mgtd::calib::report
