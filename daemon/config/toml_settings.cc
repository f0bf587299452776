// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/toml_settings.h"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

namespace mgtd::daemon::config {
namespace {

using drivers::Settings;

template <class T>
std::optional<std::vector<T>> list_of(const toml::array& array) {
  std::vector<T> out;
  for (const toml::node& item : array) {
    const auto value = item.value<T>();
    if (!value) return std::nullopt;
    out.push_back(*value);
  }
  return out;
}

std::optional<Settings::Value> value_of(const toml::node& node) {
  if (node.is_boolean()) return node.value<bool>().value();
  if (node.is_integer()) return node.value<std::int64_t>().value();
  if (node.is_floating_point()) return node.value<double>().value();
  if (node.is_string()) return node.value<std::string>().value();
  if (const toml::array* array = node.as_array()) {
    if (auto numbers = list_of<double>(*array)) return *std::move(numbers);
    if (auto texts = list_of<std::string>(*array)) return *std::move(texts);
  }
  return std::nullopt;
}

void flatten(const toml::table& table, const std::string& prefix, Settings& into) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* nested = node.as_table()) {
      flatten(*nested, name + ".", into);
      continue;
    }
    if (auto value = value_of(node)) {
      into.set(name, *std::move(value), place_of(key.source()));
    } else {
      into.set(name, std::string{}, place_of(key.source()));
      into.object(name, "this kind of value has no meaning here");
    }
  }
}

}  // namespace

tl::expected<toml::table, std::string> parse_toml(std::string_view text, std::string_view file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    return tl::unexpected(
        fmt::format("{}:{}:{}: {}; put text in quotes, and write decimals with a point, not a comma", file,
                    error.source().begin.line, error.source().begin.column, error.description()));
  }
}

drivers::Place place_of(const toml::source_region& source) {
  return {static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

Settings to_settings(const toml::table& table, std::string section) {
  Settings settings(std::move(section), place_of(table.source()));
  flatten(table, "", settings);
  return settings;
}

}  // namespace mgtd::daemon::config
