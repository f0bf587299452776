// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

namespace mgtd::calib::report {

/// wrapped() breaks text for a person into lines of at most this many characters.
inline constexpr std::size_t kTextWidth = 80;
/// For tables whose columns all stand beside each other.
inline constexpr std::size_t kAnyWidth = std::numeric_limits<std::size_t>::max();

/// Words in lines of at most kTextWidth, each line indented; a longer word has a line of its own.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t indent = 0);

/// Characters as they are seen: of UTF-8, all but the bytes that continue one.
[[nodiscard]] std::size_t seen_width(std::string_view text);

}  // namespace mgtd::calib::report
