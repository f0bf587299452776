// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace mgtd::calib::report::figures {

/// escaped() writes text as HTML and SVG need it, inside an element or an attribute in quotes: `&`, `<`, `>`
/// and both quotes become references. What XML cannot hold (control characters, bytes that are no UTF-8)
/// becomes U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

/// Length of the well-formed UTF-8 character at the start of `text`; 0 where there is none.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

}  // namespace mgtd::calib::report::figures
