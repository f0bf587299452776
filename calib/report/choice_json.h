// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "calib/criticism/search/choice.h"

/// A run file keeps the Choice that was made when an effect was added; these write it as JSON and read it
/// back.
namespace mgtd::calib::report {

[[nodiscard]] nlohmann::json to_json(const criticism::search::Choice& choice);
/// Empty (no spec) where the object is no choice: files of earlier versions have none.
[[nodiscard]] criticism::search::Choice choice_from_json(const nlohmann::json& object);

}  // namespace mgtd::calib::report
