// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// The part of the configuration that belongs to one device, as a driver reads it.
///
/// Nested tables are flattened ("axes.azimuth"). Mistakes are collected with their line, not thrown: the
/// operator sees all of them at once.
namespace mgtd::drivers {

struct SettingError {
  int line{0};
  std::string message;
};

class Settings {
 public:
  using Value =
      std::variant<bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>>;

  Settings() = default;
  /// `section` names the part in messages, e.g. "sensor s1"; `line` is where it starts.
  Settings(std::string section, int line) : section_(std::move(section)), line_(line) {}

  void set(std::string key, Value value, int line) {
    entries_[std::move(key)] = Entry{std::move(value), line, false};
  }
  [[nodiscard]] bool has(std::string_view key) const { return entries_.find(key) != entries_.end(); }
  [[nodiscard]] const std::string& section() const { return section_; }
  [[nodiscard]] int line_of(std::string_view key) const;

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
  /// Call last: keys nobody asked for become errors that name the nearest known key.
  void refuse_unknown();
  [[nodiscard]] const std::vector<SettingError>& errors() const { return errors_; }

 private:
  struct Entry {
    Value value;
    int line{0};
    bool used{false};
  };
  Entry* find(std::string_view key);
  void wrong_type(std::string_view key, std::string_view expected);
  void missing(std::string_view key);

  std::string section_;
  int line_{0};
  std::map<std::string, Entry, std::less<>> entries_;
  std::vector<std::string> asked_;
  std::vector<SettingError> errors_;
};

}  // namespace mgtd::drivers
