// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/serial_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "drivers/identity.h"
#include "proto/instrument_identity.h"

namespace mgtd::daemon::cli {
namespace {

std::string_view trimmed(std::string_view line) {
  const auto first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view{} : line.substr(first);
}

/// The value of `key = value  # comment` begins here; nothing where the line is of another key.
std::optional<std::size_t> value_at(std::string_view line, std::string_view key) {
  const std::string_view rest = trimmed(line);
  if (!rest.starts_with(key)) return std::nullopt;
  const auto equals = rest.find_first_not_of(" \t", key.size());
  if (equals == std::string_view::npos || rest[equals] != '=') return std::nullopt;
  const auto value = rest.find_first_not_of(" \t", equals + 1);
  if (value == std::string_view::npos) return std::nullopt;
  return line.size() - rest.size() + value;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    out.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

/// A section of the configuration, from its first line to the line after its last.
struct Section {
  std::string place;
  std::size_t from, to;
};

std::vector<Section> sections_of(const std::vector<std::string>& lines) {
  std::vector<Section> out;
  int sensors = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = trimmed(lines[i]);
    if (!line.starts_with('[')) continue;
    if (!out.empty() && out.back().to == lines.size()) out.back().to = i;
    if (line.starts_with("[[sensor]]")) out.push_back({fmt::format("s{}", ++sensors), i + 1, lines.size()});
    if (line.starts_with("[table]")) out.push_back({"table", i + 1, lines.size()});
    if (line.starts_with("[scalar]")) out.push_back({"scalar", i + 1, lines.size()});
  }
  return out;
}

/// What was done with one section.
enum class Done { written, stated, nothing };

Done fill_in(std::vector<std::string>& lines, const Section& section, const std::string& serial) {
  const std::string quoted = fmt::format("\"{}\"", serial);
  for (std::size_t i = section.from; i < section.to; ++i) {
    const auto value = value_at(lines[i], "serial");
    if (!value) continue;
    if (!std::string_view(lines[i]).substr(*value).starts_with("\"\"")) return Done::stated;
    lines[i].replace(*value, 2, quoted);
    return Done::written;
  }
  for (std::size_t i = section.from; i < section.to; ++i) {
    if (!value_at(lines[i], "port")) continue;
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(i) + 1, "serial = " + quoted);
    return Done::written;
  }
  return Done::nothing;
}

}  // namespace

SerialLines with_serials(std::string_view text, const std::map<std::string, std::string>& serials) {
  std::vector<std::string> lines = lines_of(text);
  std::vector<Section> sections = sections_of(lines);
  std::reverse(sections.begin(), sections.end());  // a line that is put in moves those below it
  SerialLines out;
  for (const Section& section : sections) {
    const auto serial = serials.find(section.place);
    if (serial == serials.end()) continue;
    const Done done = fill_in(lines, section, serial->second);
    if (done == Done::written) out.written.push_back(section.place);
    if (done == Done::stated) out.stated.push_back(section.place);
  }
  for (std::vector<std::string>* const places : {&out.written, &out.stated})
    std::reverse(places->begin(), places->end());
  for (const std::string& line : lines) out.text += line + "\n";
  return out;
}

std::string stated_serial(std::string_view driver, const std::string& identity) {
  if (driver == "gcs2") return drivers::serial_of_idn(identity);
  if (driver == "gsm") return drivers::serial_of_gsm(identity);
  return std::string(serial_of({"", identity}));
}

}  // namespace mgtd::daemon::cli
