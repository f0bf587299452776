// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

/// parse_number() and parse_integer() read numbers as instruments write them, in every locale alike; the
/// whole text must be the number.
namespace mgtd {

/// Accepts an optional sign ('+' too, which from_chars refuses); refuses nan, inf, blanks and trailing text.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);

}  // namespace mgtd
