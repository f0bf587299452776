// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// These functions take the text of a table apart into lines and cells, as RFC 4180 has them: a cell may
/// stand in double quotes, in which a delimiter is none and a quote is written twice. A cell ends with its
/// line.
namespace mgtd::calib::poses {

struct TableCell {
  std::string text;       ///< without its quotes and the blanks around it
  std::size_t column{1};  ///< 1-based position of its first character in the line
};

/// The cells of a line. ' ' stands for any run of blanks.
[[nodiscard]] std::vector<TableCell> cells_of(std::string_view line, char delimiter);

/// The text as a cell: in quotes where it needs them.
[[nodiscard]] std::string cell_text(const std::string& text);

/// Takes the next line off the front of the text; it ends with LF, CR LF or CR.
[[nodiscard]] std::string_view take_line(std::string_view& text);

/// What a text is that is no text of single bytes, from its beginning: "the file is UTF-16 text"; empty where
/// it can be one.
[[nodiscard]] std::string_view no_text(std::string_view beginning);

}  // namespace mgtd::calib::poses
