// SPDX-License-Identifier: Apache-2.0
#include "calib/report/column_blocks.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/report/seen_width.h"

namespace mgtd::calib::report {
namespace {

/// Blocks whose cells have the width of their column in `cell_widths`.
std::string blocks(const std::vector<NamedRow>& rows, std::size_t name_width,
                   const std::vector<std::size_t>& cell_widths, std::size_t width) {
  std::string out;
  for (std::size_t first = 0, end = 0; first < cell_widths.size(); first = end) {
    std::size_t taken = name_width;
    for (end = first; end < cell_widths.size() && (end == first || taken + cell_widths[end] <= width); ++end)
      taken += cell_widths[end];
    if (first > 0) out += "\n";
    for (const NamedRow& row : rows) {
      out += fmt::format("{:<{}}", row.name, name_width);
      for (std::size_t c = first; c < end; ++c) out += fmt::format("{:>{}}", row.cells.at(c), cell_widths[c]);
      out += "\n";
    }
  }
  return out;
}

}  // namespace

std::string column_blocks(const std::vector<NamedRow>& rows, std::size_t name_width, std::size_t cell_width,
                          std::size_t width) {
  const std::size_t columns = rows.empty() ? 0 : rows.front().cells.size();
  return blocks(rows, name_width, std::vector<std::size_t>(columns, cell_width), width);
}

std::string column_blocks(const std::vector<NamedRow>& rows, std::size_t width) {
  constexpr std::size_t kBetween = 2;
  std::size_t name_width = 0;
  std::vector<std::size_t> cell_widths(rows.empty() ? 0 : rows.front().cells.size());
  for (const NamedRow& row : rows) {
    name_width = std::max(name_width, seen_width(row.name));
    for (std::size_t c = 0; c < cell_widths.size(); ++c)
      cell_widths[c] = std::max(cell_widths[c], kBetween + seen_width(row.cells.at(c)));
  }
  return blocks(rows, name_width, cell_widths, width);
}

}  // namespace mgtd::calib::report
