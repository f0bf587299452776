// SPDX-License-Identifier: Apache-2.0
#include "proto/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mgtd {
namespace {

using nlohmann::json;

/// Takes every value and remembers only where the text stops being JSON.
struct ErrorPosition : nlohmann::json_sax<json> {
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t at, const std::string&, const nlohmann::detail::exception&) override {
    position = at;
    return false;
  }
  std::size_t position{0};  ///< bytes that were read, the wrong one among them
};

/// Walks over JSON that is known to be well formed. The library says where a text stops being JSON, but up to
/// version 3.11 it does not keep where in the text a value stood.
class Walker {
 public:
  explicit Walker(std::string_view text) : text_(text) {}

  /// Offset of the value that the tokens lead to; of the last one on the way that is there.
  std::size_t find(std::vector<std::string> path) {
    std::reverse(path.begin(), path.end());
    space();
    while (!path.empty() && enter(path.back())) path.pop_back();
    return at_;
  }

 private:
  /// Stands at a value; afterwards at its member `name`. Stays where it has none.
  bool enter(const std::string& name) {
    const std::size_t start = at_;
    const bool object = at_ < text_.size() && text_[at_] == '{';
    if (!object && !(at_ < text_.size() && text_[at_] == '[')) return false;
    ++at_;
    for (std::size_t i = 0;; ++i) {
      space();
      if (at_ >= text_.size() || text_[at_] == '}' || text_[at_] == ']') break;
      std::string key = std::to_string(i);
      if (object) {
        const std::size_t from = at_;
        string();
        key = json::parse(text_.substr(from, at_ - from), nullptr, false).get<std::string>();
        space();
        ++at_;  // the colon
        space();
      }
      if (key == name) return true;
      value();
      space();
      if (at_ < text_.size() && text_[at_] == ',') ++at_;
    }
    at_ = start;
    return false;
  }

  void space() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

  void string() {
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_)
      if (text_[at_] == '\\') ++at_;
    ++at_;
  }

  void value() {
    int depth = 0;
    do {
      if (text_[at_] == '"') {
        string();
      } else {
        if (text_[at_] == '{' || text_[at_] == '[') ++depth;
        if (text_[at_] == '}' || text_[at_] == ']') --depth;
        ++at_;
      }
    } while (at_ < text_.size() &&
             (depth > 0 || std::string_view(",}] \t\r\n").find(text_[at_]) == std::string_view::npos));
  }

  std::string_view text_;
  std::size_t at_{0};
};

std::string kind(const json& value) {
  if (value.is_null()) return "nothing (null)";
  if (value.is_boolean()) return "true or false";
  if (value.is_number()) return "a number";
  if (value.is_string()) return "a text";
  return value.is_array() ? "a list" : "an object";
}

Misfit misfit_at(const json::json_pointer& at, std::string_view what) {
  const std::string path = at.to_string();
  return {at, path.empty() ? std::string(what) : fmt::format("{}: {}", path.substr(1), what)};
}

std::optional<Misfit> compare(const json& example, const json& found, const json::json_pointer& at) {
  if (example.is_null()) return std::nullopt;
  if (kind(example) != kind(found))
    return misfit_at(at, fmt::format("{} belongs here, not {}", kind(example), kind(found)));
  if (example.is_object()) {
    for (const auto& [key, value] : example.items()) {
      if (!found.contains(key)) return misfit_at(at, fmt::format("the key '{}' is missing", key));
      if (auto wrong = compare(value, found[key], at / key)) return wrong;
    }
  }
  if (!example.is_array() || example.empty()) return std::nullopt;
  if (example.size() > 1 && example.size() != found.size())
    return misfit_at(at, fmt::format("{} values belong here, not {}", example.size(), found.size()));
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (auto wrong = compare(example[example.size() > 1 ? i : 0], found[i], at / i)) return wrong;
  }
  return std::nullopt;
}

std::vector<std::string> tokens(json::json_pointer at) {
  std::vector<std::string> out;
  for (; !at.empty(); at.pop_back()) out.push_back(at.back());
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace

std::string place_in(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
  return fmt::format("line {}, column {}", line, column);
}

bool nests_too_deeply(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') {
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == '[' || c == '{')) {
      if (++depth > kDeepestNesting) return true;
    } else if (!quoted && (c == ']' || c == '}')) {
      --depth;
    }
  }
  return false;
}

std::optional<std::size_t> json_breaks_at(std::string_view text) {
  ErrorPosition where;
  if (json::sax_parse(text, &where)) return std::nullopt;
  return where.position > 0 ? where.position - 1 : 0;
}

Result<json> parse_json_text(std::string_view text, std::string_view remedy) {
  if (nests_too_deeply(text))
    return fail(ErrorCode::bad_input,
                fmt::format("more than {} brackets stand inside each other", kDeepestNesting),
                std::string(remedy));
  json out = json::parse(text, nullptr, false);
  if (!out.is_discarded()) return out;
  const std::size_t at = json_breaks_at(text).value_or(0);
  if (at >= text.size())
    return fail(ErrorCode::bad_input,
                fmt::format("{}: the text ends before the JSON does", place_in(text, text.size())),
                std::string(remedy));
  return fail(ErrorCode::bad_input, fmt::format("{}: not JSON from here on", place_in(text, at)),
              std::string(remedy));
}

std::string Misfit::text(std::string_view text) const {
  return fmt::format("{}: {}", place_in(text, Walker(text).find(tokens(at))), what);
}

std::optional<Misfit> misfit(const json& example, const json& found) {
  return compare(example, found, json::json_pointer());
}

}  // namespace mgtd
