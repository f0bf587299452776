// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/criticism/search/model_change.h"

/// What a change of the model does, as an object and for a person.
namespace mgtd::calib {

/// Schema "mgt.model-change/1".
[[nodiscard]] nlohmann::json to_json(const ModelChange& change);
[[nodiscard]] std::string to_text(const ModelChange& change);
/// What was measured, against which limit.
[[nodiscard]] std::string to_text(const ModelChange& change, Veto veto);

}  // namespace mgtd::calib
