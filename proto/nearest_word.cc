// SPDX-License-Identifier: Apache-2.0
#include "proto/nearest_word.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace mgtd {
namespace {

constexpr std::size_t kFarthest = 3;

/// Levenshtein's.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> nearest_word(std::string_view wrong, std::span<const std::string> words) {
  std::optional<std::string> nearest;
  std::size_t least = kFarthest + 1;
  for (const std::string& word : words) {
    const std::size_t far = distance(word, wrong);
    if (far >= least) continue;
    least = far;
    nearest = word;
  }
  return nearest;
}

}  // namespace mgtd
