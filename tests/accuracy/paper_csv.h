// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace mgtd::testing {

/// This reads a table of the paper, tests/data/paper/tableN.csv: '#' lines name the source, then a header and
/// rows.
struct PaperTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  [[nodiscard]] double number(std::size_t row, std::size_t column) const;
};

[[nodiscard]] PaperTable paper_table(int number);

}  // namespace mgtd::testing
