// SPDX-License-Identifier: Apache-2.0
#include "drivers/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "proto/nearest_word.h"

namespace mgtd::drivers {
Place Settings::place_of(std::string_view key) const {
  if (const auto found = entries_.find(key); found != entries_.end()) return found->second.place;
  const auto inside = first_in(key);
  return inside == entries_.end() ? begin_ : inside->second.place;
}

bool Settings::has_table(std::string_view key) const { return first_in(key) != entries_.end(); }

Settings::Entries::const_iterator Settings::first_in(std::string_view table) const {
  const std::string prefix = std::string(table) + ".";
  const auto first = entries_.lower_bound(prefix);
  return first != entries_.end() && first->first.starts_with(prefix) ? first : entries_.end();
}

Settings::Entry* Settings::find(std::string_view key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
  const auto found = entries_.find(key);
  if (found == entries_.end()) return nullptr;
  found->second.used = true;
  return &found->second;
}

void Settings::wrong_type(std::string_view key, std::string_view expected) {
  SettingError error{place_of(key), fmt::format("{}: '{}' must be {}", section_, key, expected)};
  const bool told = std::any_of(errors_.begin(), errors_.end(), [&](const SettingError& before) {
    return before.line == error.line && before.column == error.column && before.message == error.message;
  });
  if (!told) errors_.push_back(std::move(error));  // a key may be read by the driver and by its owner
}

void Settings::missing(std::string_view key) {
  errors_.push_back({begin_, fmt::format("{}: '{}' is missing", section_, key)});
}

void Settings::object(std::string_view key, std::string message) {
  errors_.push_back({place_of(key), fmt::format("{}: '{}': {}", section_, key, message)});
}

double Settings::number(std::string_view key, double fallback) {
  const Entry* const entry = find(key);
  if (entry == nullptr) return fallback;
  if (const auto* d = std::get_if<double>(&entry->value)) return *d;
  if (const auto* i = std::get_if<std::int64_t>(&entry->value)) return static_cast<double>(*i);
  wrong_type(key, "a number");
  return fallback;
}

std::int64_t Settings::integer(std::string_view key, std::int64_t fallback) {
  const Entry* const entry = find(key);
  if (entry == nullptr) return fallback;
  if (const auto* i = std::get_if<std::int64_t>(&entry->value)) return *i;
  wrong_type(key, "a whole number");
  return fallback;
}

int Settings::small_integer(std::string_view key, int fallback) {
  const std::int64_t value = integer(key, fallback);
  if (std::in_range<int>(value)) return static_cast<int>(value);
  object(key, fmt::format("{} is too large", value));
  return fallback;
}

bool Settings::boolean(std::string_view key, bool fallback) {
  const Entry* const entry = find(key);
  if (entry == nullptr) return fallback;
  if (const auto* b = std::get_if<bool>(&entry->value)) return *b;
  wrong_type(key, "true or false");
  return fallback;
}

std::string Settings::text(std::string_view key, std::string_view fallback) {
  const Entry* const entry = find(key);
  if (entry == nullptr) return std::string(fallback);
  if (const auto* s = std::get_if<std::string>(&entry->value)) return *s;
  wrong_type(key, "a text in quotes");
  return std::string(fallback);
}

std::vector<double> Settings::numbers(std::string_view key, std::size_t count, std::vector<double> fallback) {
  const Entry* const entry = find(key);
  if (entry == nullptr) return fallback;
  const auto* list = std::get_if<std::vector<double>>(&entry->value);
  if (list == nullptr || list->size() != count) {
    wrong_type(key, fmt::format("a list of {} numbers", count));
    return fallback;
  }
  return *list;
}

std::vector<std::string> Settings::texts(std::string_view key) {
  const Entry* const entry = find(key);
  if (entry == nullptr) return {};
  if (const auto* list = std::get_if<std::vector<std::string>>(&entry->value)) return *list;
  const auto* numbers = std::get_if<std::vector<double>>(&entry->value);
  if (numbers != nullptr && numbers->empty()) return {};  // [] says nothing about its kind
  wrong_type(key, "a list of texts in quotes");
  return {};
}

double Settings::required_number(std::string_view key) {
  if (!has(key)) missing(key);
  return number(key, 0.0);
}

std::string Settings::required_text(std::string_view key) {
  if (!has(key)) missing(key);
  return text(key, "");
}

void Settings::refuse_other_tables(std::string_view key, std::span<const std::string_view> known,
                                   std::string_view remedy) {
  const std::string prefix = std::string(key) + ".";
  std::string told;
  for (auto& [name, entry] : entries_) {
    const std::size_t end = name.find('.', prefix.size());
    if (!name.starts_with(prefix) || end == std::string::npos) continue;
    const std::string table = name.substr(prefix.size(), end - prefix.size());
    if (std::find(known.begin(), known.end(), table) != known.end()) continue;
    entry.used = true;
    if (std::exchange(told, table) != table) object(name, fmt::format("there is no '{}': {}", table, remedy));
  }
}

void Settings::refuse_unknown() {
  for (const auto& [key, entry] : entries_) {
    if (entry.used) continue;
    std::string message = fmt::format("{}: unknown key '{}'", section_, key);
    if (const auto nearest = nearest_word(key, asked_))
      message += fmt::format(", did you mean '{}'?", *nearest);
    errors_.push_back({entry.place, std::move(message)});
  }
}

}  // namespace mgtd::drivers
