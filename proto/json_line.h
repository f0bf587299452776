// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "proto/error.h"

/// A line of a peer may be anything; this reads it as a JSON object or says what is wrong with it.
namespace mgtd {

/// Broken JSON is refused with the position; so is JSON that is no object, or nests too deeply. `example` is
/// a line that would do.
[[nodiscard]] Result<nlohmann::json> parse_json_object(std::string_view line, std::string_view example);

/// The start of a peer's text for a message: at most 40 characters, unprintable bytes replaced.
[[nodiscard]] std::string excerpt(std::string_view text);

}  // namespace mgtd
