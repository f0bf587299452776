// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace mgtd {

/// trimmed() returns the text without blanks, tabs and carriage returns at either end.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const auto from = text.find_first_not_of(kBlanks);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(kBlanks) - from + 1);
}

}  // namespace mgtd
