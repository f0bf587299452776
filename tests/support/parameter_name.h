// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cctype>
#include <string>
#include <string_view>

/// parameter_name() makes a text the name of one value of a parameterised test: its letters and digits, one
/// underscore for what stands between them. A value that is no number and no text has by default its bytes
/// for a name, addresses among them, and so another name in every build.
namespace mgtd::testing {

[[nodiscard]] inline std::string parameter_name(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      out += c;
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  if (out.ends_with('_')) out.pop_back();
  return out;
}

}  // namespace mgtd::testing
