// SPDX-License-Identifier: Apache-2.0
#include "proto/json_line.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "proto/json_text.h"

namespace mgtd {

std::string to_line(const nlohmann::ordered_json& object) {
  return object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
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
    return fail(ErrorCode::bad_input,
                fmt::format("'{}' is not JSON from character {} on", excerpt(line),
                            json_breaks_at(line).value_or(0) + 1),
                fmt::format("send one object per line, like {}", example));
  }
  if (!object.is_object()) {
    return fail(ErrorCode::bad_input, fmt::format("'{}' is not a JSON object", excerpt(line)),
                fmt::format("send one object per line, like {}", example));
  }
  return object;
}

}  // namespace mgtd
