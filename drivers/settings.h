// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Settings are the part of the configuration that belongs to one device, as a driver reads it.
///
/// Nested tables are flattened ("axes.azimuth"). Mistakes are collected with their place, not thrown: the
/// operator sees all of them at once.
namespace mgtd::drivers {

/// Where something stands in the file, from 1.
struct Place {
  int line{1};
  int column{1};
  constexpr Place() = default;
  constexpr Place(int in_line, int in_column = 1) : line(in_line), column(in_column) {}
  auto operator<=>(const Place&) const = default;
};

struct SettingError : Place {
  std::string message;
};

class Settings {
 public:
  using Value =
      std::variant<bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>>;

  Settings() = default;
  /// `section` names the part in messages, e.g. "sensor s1"; `begin` is where it starts.
  Settings(std::string section, Place begin) : section_(std::move(section)), begin_(begin) {}

  void set(std::string key, Value value, Place place) {
    entries_[std::move(key)] = Entry{std::move(value), place, false};
  }
  [[nodiscard]] bool has(std::string_view key) const { return entries_.find(key) != entries_.end(); }
  [[nodiscard]] const std::string& section() const { return section_; }
  /// Of a table: of the first key in it. Of the section where the key is absent.
  [[nodiscard]] Place place_of(std::string_view key) const;
  /// The table `key` has something in it: with "inputs.q.name", "inputs" and "inputs.q" have.
  [[nodiscard]] bool has_table(std::string_view key) const;

  /// Each returns the value, or the fallback when the key is absent; a wrong type is an error and the
  /// fallback.
  [[nodiscard]] double number(std::string_view key, double fallback);
  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t fallback);
  /// A whole number that has to fit into an int: larger ones are an error and the fallback.
  [[nodiscard]] int small_integer(std::string_view key, int fallback);
  [[nodiscard]] bool boolean(std::string_view key, bool fallback);
  [[nodiscard]] std::string text(std::string_view key, std::string_view fallback);
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count,
                                            std::vector<double> fallback);
  [[nodiscard]] std::vector<std::string> texts(std::string_view key);
  /// As above, but absence is an error.
  [[nodiscard]] double required_number(std::string_view key);
  [[nodiscard]] std::string required_text(std::string_view key);

  /// A driver's own objection to a value: "rate 200 Hz needs 47 kBd ..."
  void object(std::string_view key, std::string message);
  /// Objects once to every table below `key` that is not one of `known`; what is in it is not asked for.
  void refuse_other_tables(std::string_view key, std::span<const std::string_view> known,
                           std::string_view remedy);
  /// Call last: keys nobody asked for become errors that name the nearest known key.
  void refuse_unknown();
  [[nodiscard]] const std::vector<SettingError>& errors() const { return errors_; }

 private:
  struct Entry {
    Value value;
    Place place;
    bool used{false};
  };
  using Entries = std::map<std::string, Entry, std::less<>>;
  Entry* find(std::string_view key);
  [[nodiscard]] Entries::const_iterator first_in(std::string_view table) const;
  void wrong_type(std::string_view key, std::string_view expected);
  void missing(std::string_view key);

  std::string section_;
  Place begin_;
  Entries entries_;
  std::vector<std::string> asked_;
  std::vector<SettingError> errors_;
};

}  // namespace mgtd::drivers
