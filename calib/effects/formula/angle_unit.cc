// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/angle_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "calib/effects/formula/expression.h"

namespace mgtd::calib::effects::formula {
namespace {

constexpr std::array<std::string_view, 3> kOfRadians{"sin", "cos", "tan"};

bool part_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The name or number that begins at `at`; empty where neither does.
std::string_view word_at(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && (part_of_name(text[end]) || text[end] == '.')) ++end;
  return text.substr(at, end - at);
}

/// What stands between the bracket at `open` and the one that closes it.
std::string_view argument(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return text.substr(open + 1, i - open - 1);
  }
  return text.substr(open + 1);
}

bool converts(std::string_view word) {
  return word == "pi" || word.starts_with("0.01745") || word.starts_with(".01745") ||
         word.starts_with("57.29") || word.starts_with("57.3");
}

/// The first column in degrees of an argument that converts nothing; empty when it has none.
std::string_view unconverted(std::string_view argument) {
  std::string_view angle;
  for (std::size_t i = 0; i < argument.size();) {
    const std::string_view word = word_at(argument, i);
    if (converts(word)) return {};
    if (angle.empty() && word.ends_with("_deg")) angle = word;
    i += std::max<std::size_t>(1, word.size());
  }
  return angle;
}

}  // namespace

Result<void> check_angles(std::string_view expression) {
  for (std::size_t i = 0; i < expression.size();) {
    const std::string_view word = word_at(expression, i);
    std::size_t open = i + word.size();
    while (open < expression.size() && expression[open] == ' ') ++open;
    if (std::find(kOfRadians.begin(), kOfRadians.end(), word) != kOfRadians.end() &&
        open < expression.size() && expression[open] == '(') {
      const std::string_view inner = argument(expression, open), angle = unconverted(inner);
      if (!angle.empty())
        return tl::unexpected(expression_error(
            expression, i + 1, fmt::format("{} is in degrees, and {} takes radians", angle, word),
            fmt::format("did you mean {0}d({1})? The same in radians is {0}(({1})*pi/180)", word, inner)));
    }
    i += std::max<std::size_t>(1, word.size());
  }
  return {};
}

}  // namespace mgtd::calib::effects::formula
