// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "proto/error.h"

/// These functions read and write JSON objects that are lines of text. A line of a peer may be anything: it
/// is read as an object, or what is wrong with it is said.
namespace mgtd {

/// Broken JSON is refused with the position; so is JSON that is no object, or nests too deeply. `example` is
/// a line that would do.
[[nodiscard]] Result<nlohmann::json> parse_json_object(std::string_view line, std::string_view example);

/// Without an end of line. Bytes that are not UTF-8 (an instrument's answer, a peer's line) must not end a
/// stream: they are replaced.
[[nodiscard]] std::string to_line(const nlohmann::ordered_json& object);

/// The start of a peer's text for a message: at most 40 characters, unprintable bytes replaced.
[[nodiscard]] std::string excerpt(std::string_view text);

}  // namespace mgtd
