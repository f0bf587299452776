// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>

namespace mgtd::calib::report {

inline constexpr std::size_t kTextWidth = 80;

/// Words in lines of at most kTextWidth, each line indented; a longer word has a line of its own.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t indent = 0);

}  // namespace mgtd::calib::report
