// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <vector>

/// These functions write the tables and the style of the report's page. Figures bring a style of their own
/// (calib/report/figures).
namespace mgtd::calib::report {

/// Light, dark as the screen asks for it, and printed on A4.
[[nodiscard]] std::string html_style();

using Rows = std::vector<std::vector<std::string>>;

/// `words`: text columns, read from the left. Rows in `failed` stand out. Nothing where there are no rows.
[[nodiscard]] std::string html_table(const std::vector<std::string>& head, const Rows& rows, bool words,
                                     const std::set<std::size_t>& failed = {});
/// The caption that says what to expect of a section.
[[nodiscard]] std::string html_good(const std::string& text);

}  // namespace mgtd::calib::report
