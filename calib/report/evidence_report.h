// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/criticism/search/evidence.h"

namespace mgtd::calib::report {

/// to_json() writes the evidence for one effect as JSON (mgt.why/1).
[[nodiscard]] nlohmann::json to_json(const criticism::search::Evidence& evidence);
/// For a person, in whole lines that the caller fits to the terminal: how far beyond chance, the poses that
/// carry it, without and with the effect map by map, what else it could be and what would tell.
[[nodiscard]] std::string to_text(const criticism::search::Evidence& evidence);

}  // namespace mgtd::calib::report
