// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>

/// column_blocks() lays out a table whose columns may be too many for one line: as many of them as fit stand
/// beside each other, the others in a further block below, which repeats the names of the rows.
namespace mgtd::calib::report {

struct NamedRow {
  std::string name;
  std::vector<std::string> cells;  ///< one for each column
};

/// The first of `rows` is the heading. Names have `name_width` columns, left-aligned; cells have
/// `cell_width`, right-aligned. At least one column of cells stands in a block, even where it does not fit.
[[nodiscard]] std::string column_blocks(const std::vector<NamedRow>& rows, std::size_t name_width,
                                        std::size_t cell_width, std::size_t width);
/// Every column is as wide as the widest that stands in it, with two blanks between.
[[nodiscard]] std::string column_blocks(const std::vector<NamedRow>& rows, std::size_t width);

}  // namespace mgtd::calib::report
