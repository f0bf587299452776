// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <limits>
#include <string_view>

namespace mgtd::calib::report {

/// seen_width() counts characters as they are seen: of UTF-8, all but the bytes that continue one.
[[nodiscard]] std::size_t seen_width(std::string_view text);

/// For tables whose columns all stand beside each other.
inline constexpr std::size_t kAnyWidth = std::numeric_limits<std::size_t>::max();

}  // namespace mgtd::calib::report
