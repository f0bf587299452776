// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

/// An Expression computes a number from named numbers (muParser). It may contain + - * / ^, comparisons,
/// && || and ?:, sin cos tan of radians, sind cosd tand of degrees, asin acos atan sinh cosh tanh exp ln log2
/// log10 sqrt abs sign rint min max, pi. It has one value; no assignment, no text, no access to anything.
namespace mgtd::calib::effects::formula {

class Expression {
 public:
  /// Refuses what is no expression, with the column and a mark under it.
  [[nodiscard]] static Result<Expression> parse(std::string_view text);
  /// The names it uses, in alphabetical order.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  /// With a value for each name. NaN where it has none. From any thread.
  [[nodiscard]] double operator()(std::span<const double> values) const;

 private:
  Expression(std::string text, std::vector<std::string> names);

  std::string text_;
  std::vector<std::string> names_;
};

/// An error at a place of an expression: message, the text, and a mark under `column` (1-based).
[[nodiscard]] Error expression_error(std::string_view text, std::size_t column, const std::string& message,
                                     std::string remedy);
/// 1-based column of a name as a whole word; 1 when it is not there.
[[nodiscard]] std::size_t column_of(std::string_view text, std::string_view name);

}  // namespace mgtd::calib::effects::formula
