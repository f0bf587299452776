// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "proto/error.h"

/// meant_calibration() finds the calibration that an operator means by a word.
namespace mgtd::daemon::cli {

/// The id that `word` stands for among the calibrations of the daemon (the answer to `calibrations.list`):
/// the id itself, the beginning of one id only, or "latest" for the newest proposal.
[[nodiscard]] Result<std::string> meant_calibration(const std::string& word,
                                                    const nlohmann::json& calibrations);

}  // namespace mgtd::daemon::cli
