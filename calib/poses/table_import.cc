// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/table_import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "calib/poses/table_text.h"
#include "proto/nearest_word.h"
#include "proto/number.h"
#include "proto/time.h"
#include "proto/trimmed.h"

namespace mgtd::calib::poses {
namespace {

/// The delimiter that a line is full of.
char delimiter_of(std::string_view line) {
  char best = ' ';
  std::ptrdiff_t most = 0;
  for (const char delimiter : {',', ';', '\t', '|'}) {
    const auto count = std::count(line.begin(), line.end(), delimiter);
    if (count > most) most = count, best = delimiter;
  }
  return best;
}

class Importer {
 public:
  Importer(std::string_view text, std::string_view file, const ImportMap& map)
      : text_(text), file_(file), map_(map) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  }

  Result<std::string> run() {
    if (const std::string_view what = no_text(text_.substr(0, text_.find('\n'))); !what.empty())
      return fail(ErrorCode::bad_input, fmt::format("{}: {}", file_, what), "save it as text in UTF-8");
    header_ = "pose" + std::string(map_.set.empty() ? "" : ",set");
    if (map_.time) header_ += map_.time->utc ? ",t_utc" : ",t_s";
    for (const ImportedColumn& column : map_.columns) header_ += "," + cell_text(column.to);
    while (next_line()) {
      if (line_number_ <= map_.skip || trimmed(line_).empty() || is_comment()) {
        leave_line();
        continue;
      }
      if (!delimiter_) delimiter_ = map_.delimiter.value_or(delimiter_of(line_));
      const std::vector<TableCell> cells = cells_of(line_, *delimiter_);
      if (names_.empty()) {
        if (auto named = name_columns(cells); !named) return tl::unexpected(named.error());
        if (map_.header) {
          begin();
          continue;
        }
      }
      if (auto taken = take(cells); !taken) return tl::unexpected(taken.error());
    }
    if (taken_ == 0)
      return fail(ErrorCode::bad_input, fmt::format("{}: no row that could be taken", file_),
                  "look at `skip`, `header` and `comment` of the map");
    return std::move(out_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> complain(std::size_t column, std::string message,
                                               std::string remedy) const {
    return fail(ErrorCode::bad_input, fmt::format("{}:{}:{}: {}", file_, line_number_, column, message),
                std::move(remedy));
  }

  bool next_line() {
    if (text_.empty()) return false;
    line_ = take_line(text_);
    ++line_number_;
    return true;
  }
  [[nodiscard]] bool is_comment() const {
    return !map_.comment.empty() && trimmed(line_).starts_with(map_.comment);
  }
  /// The header of the pose table stands in the line of the file's own; without one, in a line more.
  void begin() {
    out_ += header_ + "\n";
    begun_ = true;
  }
  void leave_line() { out_ += "\n"; }

  Result<void> name_columns(const std::vector<TableCell>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      names_.push_back(map_.header ? cells[i].text : std::to_string(i + 1));
    for (const ImportedColumn& column : map_.columns) {
      const auto at = place_of(column.from, cells);
      if (!at) return tl::unexpected(at.error());
      places_.push_back(*at);
    }
    if (map_.time && !map_.time->from.empty()) {
      const auto at = place_of(map_.time->from, cells);
      if (!at) return tl::unexpected(at.error());
      time_at_ = *at;
    }
    return {};
  }

  /// `header`: the cells that names_ were taken from.
  [[nodiscard]] Result<std::size_t> place_of(const std::string& name,
                                             const std::vector<TableCell>& header) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) {
      const auto again = std::find(found + 1, names_.end(), name);
      if (again == names_.end()) return static_cast<std::size_t>(found - names_.begin());
      return complain(header[static_cast<std::size_t>(again - names_.begin())].column,
                      fmt::format("column '{}' stands here twice", name),
                      "rename one of them in the header; or name columns by number: `header = false`, and "
                      "`skip` for the lines before the first row");
    }
    const auto near = map_.header ? nearest_word(name, names_) : std::nullopt;
    return complain(1,
                    fmt::format("there is no column '{}'{}", name,
                                near ? fmt::format(", did you mean '{}'?", *near) : ""),
                    map_.header ? fmt::format("the header names {}", fmt::join(names_, ", "))
                                : fmt::format("without a header columns are called 1 to {}", names_.size()));
  }

  Result<double> number(const TableCell& cell, const std::string& name) const {
    std::string text = cell.text;
    if (map_.decimal != '.') std::replace(text.begin(), text.end(), map_.decimal, '.');
    const auto value = parse_number(text);
    if (value) return *value;
    return complain(cell.column, fmt::format("'{}' in column {} is not a number", cell.text, name),
                    "look at `delimiter`, `decimal` and `skip` of the map; where nothing was measured the "
                    "cell is empty, and a row without a reading is left out");
  }

  Result<std::string> time(const std::vector<TableCell>& cells) {
    const ImportedTime& time = *map_.time;
    double t_s = 0;
    if (time.from.empty()) {
      t_s = static_cast<double>(rows_ - 1) / time.rate_hz.value_or(1);
    } else if (time.utc) {
      const TableCell& cell = cells[time_at_];
      const auto t = parse_utc(cell.text);
      if (!t) return complain(cell.column, t.error().message, t.error().remedy);
      if (last_utc_ && *t < *last_utc_)
        return complain(cell.column,
                        fmt::format("the time goes back: {} after {}", cell.text, format_utc(*last_utc_)),
                        "sort the rows by time");
      last_utc_ = *t;
      return format_utc(*t);
    } else {
      const auto value = number(cells[time_at_], time.from);
      if (!value) return tl::unexpected(value.error());
      if (!first_time_) first_time_ = *value;
      t_s = (*value - *first_time_) * time.unit_s;
    }
    if (t_s < last_s_)
      return complain(1, fmt::format("the time goes back: {} s after {} s", t_s, last_s_),
                      "sort the rows by time, or give the rate of the rows: [time] rate_hz");
    last_s_ = t_s;
    return fmt::format("{}", t_s);
  }

  Result<void> take(const std::vector<TableCell>& cells) {
    if (cells.size() != names_.size())
      return complain(1, fmt::format("{} cells where {} are expected", cells.size(), names_.size()),
                      "look at `delimiter` of the map, or correct this line");
    ++rows_;
    if (!begun_) begin();
    if ((rows_ - 1) % static_cast<std::size_t>(map_.every) != 0) {
      leave_line();
      return {};
    }
    ++taken_;
    std::string row = std::to_string(taken_);
    if (!map_.set.empty()) row += "," + map_.set;
    if (map_.time) {
      const auto t = time(cells);
      if (!t) return tl::unexpected(t.error());
      row += "," + *t;
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const ImportedColumn& column = map_.columns[i];
      const TableCell& cell = cells[places_[i]];
      row += ",";
      if (cell.text.empty()) continue;
      const auto value = number(cell, column.from);
      if (!value) return tl::unexpected(value.error());
      fmt::format_to(std::back_inserter(row), "{}", column.scale * *value + column.offset);
    }
    out_ += row + "\n";
    return {};
  }

  std::string_view text_, file_, line_;
  const ImportMap& map_;
  int line_number_{0};
  std::optional<char> delimiter_{};
  std::vector<std::string> names_{};   ///< of the file's columns
  std::vector<std::size_t> places_{};  ///< of the map's columns among them
  std::size_t time_at_{0};
  std::optional<double> first_time_{};
  double last_s_{0};
  std::optional<WallTime> last_utc_{};
  std::size_t rows_{0}, taken_{0};
  bool begun_{false};
  std::string header_{}, out_{};
};

}  // namespace

Result<std::string> import_table(std::string_view text, std::string_view file, const ImportMap& map) {
  return Importer(text, file, map).run();
}

}  // namespace mgtd::calib::poses
