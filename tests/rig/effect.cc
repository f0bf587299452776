// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effect.h"

namespace mgtd::rig {

std::optional<Where> Where::parse(const std::string& text) {
  Where where;
  where.text_ = text;
  if (text == "all") return where;
  if (text.size() < 2 || text[0] != 's' || text[1] < '1' || text[1] > '4') return std::nullopt;
  where.sensor_ = text[1] - '1';
  if (text.size() == 2) return where;
  if (text.size() != 4 || text[2] != '.' || text[3] < 'x' || text[3] > 'z') return std::nullopt;
  where.axis_ = text[3] - 'x';
  return where;
}

}  // namespace mgtd::rig
