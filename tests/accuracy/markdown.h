// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

namespace mgtd::testing {

/// This writes a table of a Markdown page: the first column is text, the others are numbers.
class MarkdownTable {
 public:
  explicit MarkdownTable(const std::vector<std::string>& header) {
    line(header);
    text_ += "|---|";
    for (std::size_t c = 1; c < header.size(); ++c) text_ += "---:|";
    text_ += "\n";
  }
  void line(const std::vector<std::string>& cells) {
    text_ += "|";
    for (const std::string& cell : cells) text_ += " " + cell + " |";
    text_ += "\n";
  }
  template <class Numbers>
  void numbers(const std::string& name, const Numbers& values, int decimals) {
    std::vector<std::string> cells{name};
    for (const double v : values) cells.push_back(fmt::format("{:.{}f}", v, decimals));
    line(cells);
  }
  [[nodiscard]] std::string text() const { return text_ + "\n"; }

 private:
  std::string text_;
};

}  // namespace mgtd::testing
