// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

/// These functions write how old something is, in few enough words for a column of a table.
namespace mgtd::daemon::cli {

/// "8 s", "12 min", "5 h", "3 days": to a whole unit, of which there are at least two.
[[nodiscard]] std::string age_text(double seconds);

/// "made 3 days ago at 11.9 to 12.3 degC, now 31.0 degC", of `calibration` in STATUS; what is not known is
/// left out, and nothing is left where its age and its temperature are not known.
[[nodiscard]] std::string conditions_text(const nlohmann::json& calibration);

}  // namespace mgtd::daemon::cli
