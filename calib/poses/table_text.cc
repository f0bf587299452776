// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/table_text.h"

#include <algorithm>
#include <utility>

#include "proto/trimmed.h"

namespace mgtd::calib::poses {

std::vector<TableCell> cells_of(std::string_view line, char delimiter) {
  constexpr std::string_view kBlanks = " \t\r";
  const bool runs = delimiter == ' ';
  const auto parts = [&](char c) {
    return runs ? kBlanks.find(c) != std::string_view::npos : c == delimiter;
  };
  std::vector<TableCell> cells;
  std::size_t at = 0;
  while (true) {
    while (runs && at < line.size() && parts(line[at])) ++at;
    if (runs && at >= line.size()) return cells;
    TableCell cell{.text = {}, .column = at + 1};
    bool quoted = false;
    for (; at < line.size() && (quoted || !parts(line[at])); ++at) {
      const bool opens = !quoted && trimmed(cell.text).empty();  // later in a cell it is an inch sign
      if (quoted && line.substr(at, 2) == "\"\"") {
        cell.text += line[at++];
      } else if (line[at] == '"' && (quoted || opens)) {
        quoted = !quoted;
      } else {
        cell.text += line[at];
      }
    }
    cell.text = trimmed(cell.text);
    cells.push_back(std::move(cell));
    if (at >= line.size()) return cells;
    ++at;
    if (runs) continue;
    if (at == line.size()) {
      cells.push_back({.text = {}, .column = at + 1});
      return cells;
    }
  }
}

std::string cell_text(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string(2, c) : std::string(1, c);
  return out + "\"";
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end);
  text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, text.size()));
  return line;
}

std::string_view no_text(std::string_view beginning) {
  if (beginning.starts_with("\xFF\xFE") || beginning.starts_with("\xFE\xFF"))
    return "the file is UTF-16 text";
  if (beginning.find('\0') != std::string_view::npos) return "the file is no text: it holds zero bytes";
  return {};
}

}  // namespace mgtd::calib::poses
