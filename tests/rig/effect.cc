// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effect.h"

#include <charconv>

namespace mgtd::rig {

std::optional<Where> Where::parse(const std::string& text, std::size_t sensors) {
  Where where;
  where.text_ = text;
  if (text == "all") return where;
  if (text.size() < 2 || text[0] != 's' || text[1] == '0') return std::nullopt;
  const char* const end = text.data() + text.size();
  std::size_t number = 0;
  const auto [rest, error] = std::from_chars(text.data() + 1, end, number);
  if (error != std::errc{} || number < 1 || number > sensors) return std::nullopt;
  where.sensor_ = static_cast<int>(number) - 1;
  if (rest == end) return where;
  if (end - rest != 2 || rest[0] != '.' || rest[1] < 'x' || rest[1] > 'z') return std::nullopt;
  where.axis_ = rest[1] - 'x';
  return where;
}

}  // namespace mgtd::rig
