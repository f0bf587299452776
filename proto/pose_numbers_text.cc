// SPDX-License-Identifier: Apache-2.0
#include "proto/pose_numbers_text.h"

#include <fmt/format.h>

namespace mgtd {

std::string pose_numbers_text(const std::set<int>& numbers) {
  std::string out;
  for (auto it = numbers.begin(); it != numbers.end();) {
    const int first = *it;
    int last = first;
    while (++it != numbers.end() && *it == last + 1) last = *it;
    if (!out.empty()) out += ",";
    out += first == last ? fmt::format("{}", first) : fmt::format("{}-{}", first, last);
  }
  return out;
}

}  // namespace mgtd
