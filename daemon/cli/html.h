// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <vector>

/// This makes the tables and the style of the report's page.
namespace mgtd::daemon::cli {

extern const char* const kHtmlStyle;

using Rows = std::vector<std::vector<std::string>>;

/// `words`: text columns, read from the left. Rows in `failed` stand out.
[[nodiscard]] std::string html_table(const std::vector<std::string>& head, const Rows& rows, bool words,
                                     const std::set<std::size_t>& failed = {});
/// The caption that says what to expect of a section.
[[nodiscard]] std::string html_good(const std::string& text);

}  // namespace mgtd::daemon::cli
