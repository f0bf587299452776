// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/import_map_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <vector>

#include "daemon/config/toml_settings.h"

namespace mgtd::daemon::cli {
namespace {

using calib::poses::ImportedColumn;
using calib::poses::ImportedTime;
using calib::poses::ImportMap;
using drivers::Settings;

constexpr const char* kRemedy = "docs/import.md shows what such a file holds";

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  Result<ImportMap> read(const toml::table& root) {
    for (const auto& [key, node] : root) {
      if (!node.is_table() || (key != "columns" && key != "time" && key != "file")) {
        complain(config::place_of(key.source()),
                 fmt::format("'{}' has no meaning here; there are [columns], [time] and [file]", key.str()));
      }
    }
    if (const toml::table* columns = root["columns"].as_table()) read_columns(*columns);
    if (const toml::table* time = root["time"].as_table()) read_time(*time);
    if (const toml::table* file = root["file"].as_table()) read_file(*file);
    if (map_.columns.empty() && lines_.empty()) complain({}, "no column is named: [columns] is empty");
    if (!lines_.empty())
      return fail(ErrorCode::bad_input, fmt::format("{}", fmt::join(lines_, "\n")), kRemedy);
    return std::move(map_);
  }

 private:
  void complain(drivers::Place place, const std::string& message) {
    lines_.push_back(fmt::format("{}:{}:{}: {}", file_, place.line, place.column, message));
  }
  void finish(Settings& settings) {
    settings.refuse_unknown();
    for (const drivers::SettingError& error : settings.errors()) complain(error, error.message);
  }

  void read_columns(const toml::table& columns) {
    for (const auto& [key, node] : columns) {
      ImportedColumn column{.to = std::string(key.str()), .from = {}};
      if (const auto from = node.value<std::string>(); from && node.is_string()) {
        column.from = *from;
      } else if (const toml::table* table = node.as_table()) {
        read_column(*table, column);
      } else {
        complain(config::place_of(key.source()),
                 fmt::format("{}: give the name of a column, or a table with `from`", column.to));
      }
      map_.columns.push_back(std::move(column));
    }
  }

  void read_column(const toml::table& table, ImportedColumn& column) {
    Settings settings = config::to_settings(table, column.to);
    column.from = settings.required_text("from");
    column.scale = settings.number("scale", 1);
    column.offset = settings.number("offset", 0);
    const double sign = settings.number("sign", 1);
    if (sign != 1 && sign != -1) settings.object("sign", "must be 1 or -1");
    if (column.scale == 0) settings.object("scale", "0 makes every value the same");
    if (settings.has("unit")) {
      const auto step = calib::poses::unit_step(column.to, settings.text("unit", ""));
      if (step) {
        column.offset = column.offset * step->scale + step->offset;
        column.scale *= step->scale;
      } else {
        settings.object("unit", step.error().message + "; " + step.error().remedy);
      }
    }
    column.scale *= sign;
    finish(settings);
  }

  void read_time(const toml::table& table) {
    Settings settings = config::to_settings(table, "time");
    ImportedTime time;
    time.from = settings.text("from", "");
    const std::string unit = settings.text("unit", "s");
    if (unit == "utc") {
      time.utc = true;
    } else if (const auto step = calib::poses::unit_step("t_s", unit)) {
      time.unit_s = step->scale;
    } else {
      settings.object("unit", step.error().message + "; " + step.error().remedy + ", or utc");
    }
    if (settings.has("rate_hz")) {
      time.rate_hz = settings.number("rate_hz", 1);
      if (!(*time.rate_hz > 0)) settings.object("rate_hz", "must be above 0");
    }
    if (time.from.empty() == !time.rate_hz.has_value())
      settings.object(time.rate_hz ? "rate_hz" : "from",
                      "give either the column `from` or the rate `rate_hz`");
    map_.time = std::move(time);
    finish(settings);
  }

  void read_file(const toml::table& table) {
    Settings settings = config::to_settings(table, "file");
    if (settings.has("delimiter")) {
      const std::string delimiter = settings.text("delimiter", ",");
      if (delimiter == "tab") {
        map_.delimiter = '\t';
      } else if (delimiter == "blanks" || delimiter == " ") {
        map_.delimiter = ' ';
      } else if (delimiter.size() == 1) {
        map_.delimiter = delimiter.front();
      } else {
        settings.object("delimiter", "must be one character, \"tab\" or \"blanks\"");
      }
    }
    map_.header = settings.boolean("header", map_.header);
    map_.skip = settings.small_integer("skip", map_.skip);
    if (map_.skip < 0) settings.object("skip", "must be 0 or more");
    map_.comment = settings.text("comment", map_.comment);
    const std::string decimal = settings.text("decimal", ".");
    if (decimal != "." && decimal != ",") settings.object("decimal", "must be \".\" or \",\"");
    map_.decimal = decimal.empty() ? '.' : decimal.front();
    map_.every = settings.small_integer("every", map_.every);
    if (map_.every < 1) settings.object("every", "must be 1 or more");
    map_.set = settings.text("set", map_.set);
    if (map_.set.find_first_of(",\r\n\"") != std::string::npos)
      settings.object("set", "must be a word without commas and quotes");
    finish(settings);
  }

  std::string file_;
  ImportMap map_{};
  std::vector<std::string> lines_{};
};

}  // namespace

Result<ImportMap> import_map_from_text(std::string_view text, const std::string& file) {
  const auto root = config::parse_toml(text, file);
  if (!root) return fail(ErrorCode::bad_input, root.error(), kRemedy);
  return Reader(file).read(*root);
}

}  // namespace mgtd::daemon::cli
