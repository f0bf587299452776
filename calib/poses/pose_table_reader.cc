// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/pose_table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "calib/poses/field_unit.h"
#include "proto/number.h"
#include "proto/trimmed.h"

namespace mgtd::calib::poses {
namespace {

constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

bool is_angle(std::string_view name) {
  return name == "azimuth_deg" || name == "pitch_deg" || name == "roll_deg";
}

/// Of a column that belongs to one sensor: which, from 1, and whether it is one of its readings.
struct OfSensor {
  std::size_t number{0};
  bool reading{false};
};

/// Empty for any other column. The number may be one that no array has.
std::optional<OfSensor> of_sensor(std::string_view name) {
  const std::size_t end = name.find('_');
  if (!name.starts_with('s') || end == std::string_view::npos || end < 2 || end > 4) return std::nullopt;
  const std::string_view digits = name.substr(1, end - 1), what = name.substr(end + 1);
  if (digits.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  if (digits.size() > 1 && digits.front() == '0') return std::nullopt;
  const bool reading = what == "x_nT" || what == "y_nT" || what == "z_nT";
  if (!reading && what != "sd_x_nT" && what != "sd_y_nT" && what != "sd_z_nT" && what != "T_degC")
    return std::nullopt;
  return OfSensor{static_cast<std::size_t>(parse_integer(digits).value_or(0)), reading};
}

/// What to do about a number that its column cannot hold.
std::string remedy_of_limits(const PoseColumn& column, double value) {
  const std::string_view unless = column.required ? "leave the whole pose out when it is wrong"
                                                  : "leave the cell empty when it was not measured";
  const bool field = column.name.ends_with("_nT") && column.name.find("sd_") == std::string::npos;
  const auto unit = field ? field_unit_of(std::abs(value) / kEarthlyField_nT) : std::nullopt;
  if (!unit) return fmt::format("check unit and column; {}", unless);
  return fmt::format("the column looks like {}: multiply all of it by {}; if it is this row alone, {}",
                     unit->name, unit->factor, unless);
}

constexpr std::array<std::string_view, 3> kReference{"ref_x_nT", "ref_y_nT", "ref_z_nT"};

/// What a file is whose first line cannot be a header; empty where it can.
std::string_view no_table(std::string_view line) {
  if (const std::string_view what = no_text(line); !what.empty()) return what;
  if (line.starts_with('{')) return "the file is JSON, not a table";
  if (line.find(',') == std::string_view::npos && line.find(';') != std::string_view::npos)
    return "its columns are separated by semicolons";
  if (line.find(',') == std::string_view::npos && line.find('\t') != std::string_view::npos)
    return "its columns are separated by tabs";
  return {};
}

}  // namespace

PoseTableReader::PoseTableReader(std::string_view text, std::string_view file, Rows rows, std::size_t sensors,
                                 std::string_view map)
    : text_(text), file_(file), map_(map), rows_(rows), sensors_(sensors) {
  if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
}

PoseColumn::Limits PoseTableReader::limits_of(const PoseColumn& column) const {
  return column.name == "f_nT" && with_reference_ ? field_limits_beside_reference() : column.limits;
}

tl::unexpected<Error> PoseTableReader::complain(std::size_t column, std::string message,
                                                std::string remedy) const {
  const bool of_map = !map_.empty() && !header_read_;
  return fail(ErrorCode::bad_input,
              of_map ? fmt::format("{}: {}", map_, message)
                     : fmt::format("{}:{}:{}: {}", file_, line_number_, column, message),
              std::move(remedy));
}

std::size_t PoseTableReader::column_of(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? kNowhere : static_cast<std::size_t>(found - names_.begin());
}

bool PoseTableReader::required(const PoseColumn* column) const {
  if (column == nullptr) return false;
  return rows_ == Rows::measured ? column->required : is_angle(column->name);
}

bool PoseTableReader::next_line() {
  while (!text_.empty()) {
    line_ = take_line(text_);
    ++line_number_;
    const std::string_view content = trimmed(line_);
    if (!content.empty() && !content.starts_with('#')) return true;
  }
  return false;
}

Result<void> PoseTableReader::read_header() {
  if (!next_line()) {
    return fail(ErrorCode::bad_input, fmt::format("{}: the file is empty", file_),
                "a header row and one row per pose are needed");
  }
  if (const std::string_view what = no_table(line_); !what.empty()) {
    return fail(
        ErrorCode::bad_input, fmt::format("{}: {}", file_, what),
        "give a *.mgtrun, or a pose table in CSV: commas between the columns, a decimal point, UTF-8; "
        "mgt import --columns MAP.toml takes tables of other programs");
  }
  const std::vector<TableCell> header = cells_of(line_, ',');
  if (parse_number(header.front().text)) {
    return complain(
        header.front().column, "numbers stand where the names of the columns are needed",
        "begin the file with a header row (docs/pose-table.md has the names), or take its columns by "
        "their numbers: mgt import --columns MAP.toml");
  }
  for (const TableCell& cell : header) {
    if (cell.text.empty()) return complain(cell.column, "a column has no name", "name it in the header row");
    if (column_of(cell.text) != kNowhere) {
      return complain(cell.column, fmt::format("column '{}' stands here twice", cell.text),
                      "remove or rename one of them");
    }
    names_.emplace_back(cell.text);
  }
  if (auto counted = count_sensors(header); !counted) return counted;
  const auto& columns = pose_columns(sensors_);
  for (const std::string& name : names_) {
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
    known_.push_back(found == columns.end() ? nullptr : &*found);
  }
  auto complete = refuse_missing();
  header_read_ = true;
  return complete;
}

/// As many sensors as the readings name. Where they name none, those of the first are missed.
Result<void> PoseTableReader::count_sensors(const std::vector<TableCell>& header) {
  std::size_t most = 0;
  for (const TableCell& cell : header) {
    const auto of = of_sensor(cell.text);
    if (of && (of->number < 1 || of->number > kMostSensors)) {
      return complain(cell.column, fmt::format("{}: there is no sensor s{}", cell.text, of->number),
                      fmt::format("number the sensors s1, s2, ...; an array has at most {}", kMostSensors));
    }
    if (of && of->reading) most = std::max(most, of->number);
  }
  if (rows_ == Rows::measured) sensors_ = std::max<std::size_t>(most, 1);
  for (const TableCell& cell : header) {
    const auto of = of_sensor(cell.text);
    if (!of || of->number <= sensors_ || (rows_ == Rows::measured && most == 0)) continue;
    if (rows_ == Rows::planned)
      return complain(
          cell.column, fmt::format("{}: the array has {}", cell.text, counted(sensors_)),
          "leave the column out, or describe the array that is meant: mgt plan --array FILE.toml");
    return complain(cell.column,
                    fmt::format("{0}: there are no readings of s{1} (s{1}_x_nT, s{1}_y_nT, s{1}_z_nT)",
                                cell.text, of->number),
                    "add them, or rename this column when it is of no sensor");
  }
  return {};
}

std::string PoseTableReader::remedy_of_missing() const {
  const bool microtesla = column_of("s1_x_uT") != kNowhere;
  if (!map_.empty())
    return microtesla ? "the columns are called s1_x_nT ... also where the readings are in microtesla: give "
                        "them unit = \"uT\" (docs/import.md)"
                      : "say in [columns] of the map which column of the file it is (docs/import.md)";
  if (microtesla)
    return "the readings are in microtesla: multiply them by 1000, and call the columns s1_x_nT ...";
  return fmt::format("add it to the header row (docs/pose-table.md lists every column){}",
                     rows_ == Rows::planned
                         ? ""
                         : ", or say which column is which: mgt import --columns MAP.toml (docs/import.md)");
}

Result<void> PoseTableReader::refuse_missing() {
  std::string missing;
  for (const PoseColumn& column : pose_columns(sensors_)) {
    if (required(&column) && column_of(column.name) == kNowhere)
      missing += (missing.empty() ? "" : ", ") + column.name;
  }
  if (column_of("pose") == kNowhere) missing = "pose" + (missing.empty() ? "" : ", " + missing);
  if (!missing.empty()) {
    std::size_t read = 0;  // sensors of which there is any reading
    for (std::size_t i = 1; i <= sensors_; ++i)
      read += std::any_of(names_.begin(), names_.end(), [i](const std::string& name) {
        const auto of = of_sensor(name);
        return of && of->reading && of->number == i;
      });
    if (rows_ == Rows::measured && read > 0 && read < sensors_)
      return complain(1, fmt::format("missing column: {} (there is an s{})", missing, sensors_),
                      "number the sensors s1, s2, ... without a gap, each with x, y and z");
    return complain(1,
                    fmt::format("missing column: {}{}", missing,
                                rows_ == Rows::measured && read == 0 ? ", and those of further sensors" : ""),
                    remedy_of_missing());
  }
  const auto there = std::count_if(kReference.begin(), kReference.end(),
                                   [&](std::string_view name) { return column_of(name) != kNowhere; });
  with_reference_ = there == 3;
  if (with_reference_ || (there == 0 && column_of("ref_sd_nT") == kNowhere)) return {};
  for (const std::string_view name : kReference)
    if (column_of(name) == kNowhere) missing += (missing.empty() ? "" : ", ") + std::string(name);
  return complain(1, fmt::format("missing column: {}", missing),
                  "the reference field is a vector: give ref_x_nT, ref_y_nT and ref_z_nT, or none of them");
}

/// In a row the reference is there or not.
Result<void> PoseTableReader::refuse_part_of_reference(const Pose& pose,
                                                       const std::vector<TableCell>& cells) {
  if (!pose.ref_nT || pose.ref_nT->allFinite()) return {};
  for (const std::string_view name : kReference) {
    const TableCell& cell = cells[column_of(name)];
    if (cell.text.empty())
      return complain(cell.column, fmt::format("{} is empty, but not the whole reference field", name),
                      "give all three of ref_x_nT, ref_y_nT and ref_z_nT, or leave all three empty");
  }
  return {};
}

Result<void> PoseTableReader::read_names(Pose& pose, const std::vector<TableCell>& cells) {
  const TableCell& number = cells[column_of("pose")];
  const auto value = parse_integer(number.text);
  if (!value || std::abs(*value) > 1'000'000'000) {
    return complain(number.column, fmt::format("pose '{}' is not a whole number", number.text),
                    "number the poses 1, 2, 3, ...");
  }
  pose.number = static_cast<int>(*value);
  if (const std::size_t at = column_of("set"); at != kNowhere) pose.set = cells[at].text;
  if (const std::size_t at = column_of("note"); at != kNowhere && is_note("note")) note_ = cells[at].text;
  if (const std::size_t at = column_of("t_utc"); at != kNowhere && !cells[at].text.empty()) {
    const auto t = parse_utc(cells[at].text);
    if (!t) return complain(cells[at].column, t.error().message, t.error().remedy);
    pose.t_utc = *t;
  }
  return {};
}

Result<Pose> PoseTableReader::read_row(const std::vector<TableCell>& cells) {
  if (cells.size() != names_.size()) {
    return complain(
        1, fmt::format("{} cells, but the header names {} columns", cells.size(), names_.size()),
        "give every row as many commas as the header; leave a cell empty when nothing was measured");
  }
  Pose pose = unmeasured_pose(sensors_);
  if (auto read = read_names(pose, cells); !read) return tl::unexpected(read.error());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string& name = names_[i];
    if (name == "pose" || name == "set" || name == "t_utc" || is_note(name)) continue;
    if (cells[i].text.empty()) {
      if (!required(known_[i])) continue;
      return complain(cells[i].column, fmt::format("{} is empty", name),
                      rows_ == Rows::measured ? "leave the whole pose out when a sensor was not read"
                                              : "every planned pose needs its three angles");
    }
    const auto value = parse_number(cells[i].text);
    if (!value) {
      return complain(cells[i].column, fmt::format("'{}' in column {} is not a number", cells[i].text, name),
                      "write it with a decimal point, or leave the cell empty when it was not measured");
    }
    if (known_[i] != nullptr && known_[i]->whole &&
        !(std::abs(*value) < 1e9 && std::floor(*value) == *value)) {
      return complain(cells[i].column,
                      fmt::format("{} in column {} is not a whole number", cells[i].text, name),
                      "write it without decimals, or leave the cell empty");
    }
    if (known_[i] != nullptr && !limits_of(*known_[i]).hold(*value)) {
      return complain(cells[i].column,
                      fmt::format("{} in column {} is not possible: it must be {}", cells[i].text, name,
                                  limits_of(*known_[i]).words()),
                      remedy_of_limits(*known_[i], *value));
    }
    if (known_[i] != nullptr) {
      known_[i]->set(pose, *value);
    } else {
      pose.covariates[name] = *value;
    }
  }
  if (auto whole = refuse_part_of_reference(pose, cells); !whole) return tl::unexpected(whole.error());
  return pose;
}

Result<PoseTable> PoseTableReader::read() {
  if (auto header = read_header(); !header) return tl::unexpected(header.error());
  PoseTable table;
  table.source = file_;
  std::map<int, std::size_t> line_of_pose;
  // A pose is large and a recording has tens of thousands: they are not moved as they become more. A row has
  // at least a character for each column.
  table.poses.reserve(std::min(static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '\n')) + 1,
                               text_.size() / names_.size() + 1));
  while (next_line()) {
    auto pose = read_row(cells_of(line_, ','));
    if (!pose) return tl::unexpected(pose.error());
    const auto [where, fresh] = line_of_pose.emplace(pose->number, line_number_);
    if (!fresh) {
      return complain(1, fmt::format("pose {} was already given in line {}", pose->number, where->second),
                      "give every pose a number of its own; equal angles may repeat");
    }
    table.poses.push_back(*std::move(pose));
    notes_.push_back(std::exchange(note_, {}));
    lines_.push_back(static_cast<int>(line_number_));
  }
  if (table.poses.empty()) {
    return fail(ErrorCode::bad_input, fmt::format("{}: a header but no pose", file_),
                "one row per pose is needed");
  }
  return table;
}

}  // namespace mgtd::calib::poses
