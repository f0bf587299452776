// SPDX-License-Identifier: Apache-2.0
#include "tests/accuracy/paper_csv.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "proto/number.h"
#include "tests/support/checkout.h"

namespace mgtd::testing {

double PaperTable::number(std::size_t row, std::size_t column) const {
  const auto value = parse_number(rows.at(row).at(column));
  if (!value) throw std::runtime_error("not a number in a table of the paper: " + rows[row][column]);
  return *value;
}

PaperTable paper_table(int number) {
  const std::string path = source_path("tests/data/paper/table") + std::to_string(number) + ".csv";
  std::ifstream in(path);
  if (!in) throw std::runtime_error(path + " cannot be read");
  PaperTable out;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (out.columns.empty()) {
      out.columns = row;
    } else {
      out.rows.push_back(row);
    }
  }
  return out;
}

}  // namespace mgtd::testing
