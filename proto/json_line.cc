// SPDX-License-Identifier: Apache-2.0
#include "proto/json_line.h"

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace mgtd {
namespace {

/// Takes every value and remembers only where the text stops being JSON.
struct ErrorPosition : nlohmann::json_sax<nlohmann::json> {
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
  std::size_t position{0};
};

}  // namespace

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

std::string excerpt(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string shown(text.substr(0, kShown));
  for (char& c : shown) {
    if (c < ' ' || c > '~') c = '.';
  }
  return text.size() > kShown ? shown + "..." : shown;
}

Result<nlohmann::json> parse_json_object(std::string_view line, std::string_view example) {
  if (nests_too_deeply(line))
    return fail(
        ErrorCode::bad_input,
        fmt::format("'{}' nests more than {} brackets into each other", excerpt(line), kDeepestNesting),
        fmt::format("send one object per line, like {}", example));
  nlohmann::json object = nlohmann::json::parse(line, nullptr, false);
  if (object.is_discarded()) {
    ErrorPosition where;
    nlohmann::json::sax_parse(line, &where);
    return fail(ErrorCode::bad_input,
                fmt::format("'{}' is not JSON from character {} on", excerpt(line), where.position),
                fmt::format("send one object per line, like {}", example));
  }
  if (!object.is_object()) {
    return fail(ErrorCode::bad_input, fmt::format("'{}' is not a JSON object", excerpt(line)),
                fmt::format("send one object per line, like {}", example));
  }
  return object;
}

}  // namespace mgtd
