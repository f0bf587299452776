// SPDX-License-Identifier: Apache-2.0
#include "calib/report/column_blocks.h"

#include <fmt/format.h>

#include <algorithm>

namespace mgtd::calib::report {

std::string column_blocks(const std::vector<NamedRow>& rows, std::size_t name_width, std::size_t cell_width,
                          std::size_t width) {
  const std::size_t columns = rows.empty() ? 0 : rows.front().cells.size();
  const std::size_t room = width > name_width ? (width - name_width) / cell_width : 0;
  const std::size_t beside = std::max<std::size_t>(1, room);
  std::string out;
  for (std::size_t first = 0; first < columns; first += beside) {
    if (first > 0) out += "\n";
    for (const NamedRow& row : rows) {
      out += fmt::format("{:<{}}", row.name, name_width);
      for (std::size_t c = first; c < std::min(columns, first + beside); ++c)
        out += fmt::format("{:>{}}", row.cells.at(c), cell_width);
      out += "\n";
    }
  }
  return out;
}

}  // namespace mgtd::calib::report
