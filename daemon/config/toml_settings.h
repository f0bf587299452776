// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <toml++/toml.h>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "drivers/settings.h"

/// to_settings() turns one TOML table into Settings: nested tables are flattened with dots, and every key
/// knows its place in the file.
namespace mgtd::daemon::config {

/// "file:line:column: what is wrong", where `text` is not TOML.
[[nodiscard]] tl::expected<toml::table, std::string> parse_toml(std::string_view text, std::string_view file);

[[nodiscard]] drivers::Place place_of(const toml::source_region& source);

/// Values that Settings has no type for (dates, mixed lists, tables in lists) are objected to by name.
[[nodiscard]] drivers::Settings to_settings(const toml::table& table, std::string section);

}  // namespace mgtd::daemon::config
