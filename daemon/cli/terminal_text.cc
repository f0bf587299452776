// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/terminal_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>

#include "calib/report/seen_width.h"

namespace mgtd::daemon::cli {
namespace {

constexpr std::size_t kFewestColumns = 20;

/// Where the rest of a broken line stands.
std::size_t hanging_indent(std::string_view line, std::size_t width) {
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  std::size_t column = begin;
  for (std::size_t at = line.find("  ", begin); at != std::string_view::npos; at = line.find("  ", at)) {
    at = line.find_first_not_of(' ', at);
    if (at == std::string_view::npos || at > width * 3 / 5) break;
    column = at;
  }
  return column;
}

std::string broken(std::string_view line, std::size_t width) {
  const std::size_t indent = hanging_indent(line, width);
  std::string out, row(line.substr(0, indent));
  bool empty = true;
  for (std::size_t at = indent; at < line.size();) {
    const std::size_t end = std::min(line.find(' ', line.find_first_not_of(' ', at)), line.size());
    const std::string_view word = line.substr(at, end - at);
    if (!empty && calib::report::seen_width(row) + calib::report::seen_width(word) > width) {
      out += row + "\n";
      row = std::string(indent, ' ');
      row += word.substr(std::min(word.find_first_not_of(' '), word.size()));
    } else {
      row += word;
    }
    empty = false;
    at = end;
  }
  return out + row;
}

struct Rule {
  std::regex line;  ///< what stands before the judgement, and the judgement
  const char* escape;
};

constexpr const char *kGreen = "\x1b[32m", *kYellow = "\x1b[33m", *kRed = "\x1b[31m", *kPlain = "\x1b[0m";

/// The first that matches a line counts.
const std::array<Rule, 9>& rules() {
  static const std::array<Rule, 9> kRules{{
      {std::regex(R"(^( *)(ok|PASS)(?=[ :]|$))"), kGreen},
      {std::regex(R"(^( *)(FAIL|BAD-DATA)(?=[ :]|$))"), kRed},
      {std::regex(R"(^( *)(failed)(?=:))"), kRed},
      {std::regex(R"(^( *)(EXPLAINED|AMBIGUOUS|PARTIAL|UNKNOWN)(?=[ :]|$))"), kYellow},
      {std::regex(R"(^(.*calibration .*: )(NOT ACCEPTED)$)"), kRed},
      {std::regex(R"(^(.*calibration .*: )(accepted by its checks)$)"), kGreen},
      {std::regex(R"(^(judged +|\S+ +)(ok|live)(?=  |$))"), kGreen},
      {std::regex(R"(^(judged +|\S+ +)(learning|opening|probing)(?=  |$))"), kYellow},
      {std::regex(R"(^(judged +|\S+ +)(suspect|near source|identity|exchanged|turned|absent|silent|failed|)"
                  R"(frozen|saturated|gone)(?=  |$))"),
       kRed},
  }};
  return kRules;
}

std::string colored_line(const std::string& line) {
  std::smatch found;
  for (const Rule& rule : rules())
    if (std::regex_search(line, found, rule.line))
      return fmt::format("{}{}{}{}{}", found[1].str(), rule.escape, found[2].str(), kPlain,
                         found.suffix().str());
  return line;
}

/// The text with each of its lines changed.
template <class Change>
std::string by_lines(std::string_view text, const Change& change) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    out += change(text.substr(0, end));
    if (end == std::string_view::npos) break;
    out += '\n';
    text.remove_prefix(end + 1);
  }
  return out;
}

}  // namespace

TextLook look_of(const Output& output, std::string_view color) {
  TextLook look;
  if (output.terminal)
    look.width = std::max(kFewestColumns, static_cast<std::size_t>(std::max(output.columns, 0)));
  look.colored = color == "always" ||
                 (color != "never" && output.terminal && output.no_color.empty() && output.term != "dumb");
  return look;
}

std::string fitted(std::string_view text, std::size_t width) {
  return by_lines(text, [width](std::string_view line) {
    if (calib::report::seen_width(line) <= width || line.starts_with("  mgt ")) return std::string(line);
    return broken(line.substr(0, line.find_last_not_of(' ') + 1), width);  // an empty cell ends a row
  });
}

std::string colored(std::string_view text) {
  return by_lines(text, [](std::string_view line) { return colored_line(std::string(line)); });
}

std::string shown(std::string_view text, const TextLook& look) {
  std::string out = look.width ? fitted(text, *look.width) : std::string(text);
  return look.colored ? colored(out) : out;
}

}  // namespace mgtd::daemon::cli
