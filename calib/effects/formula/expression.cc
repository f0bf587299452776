// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "calib/effects/formula/parser_functions.h"

namespace mgtd::calib::effects::formula {
namespace {

constexpr const char* kRemedy =
    "operators + - * / ^, comparisons, a ? b : c, and sin, cos, tan (of radians), sind, cosd, tand (of "
    "degrees), exp, ln, sqrt, abs, sign, min, max, tanh";

/// A parser carries the state of one evaluation, so every thread has its own of each expression.
struct Compiled {
  mu::Parser parser;
  std::vector<double> values;

  Compiled(const std::string& text, const std::vector<std::string>& names) : values(names.size()) {
    define_functions(parser);
    for (std::size_t i = 0; i < names.size(); ++i) parser.DefineVar(names[i], &values[i]);
    parser.SetExpr(text);
  }
};

Compiled& on_this_thread(const std::string& text, const std::vector<std::string>& names) {
  thread_local std::map<std::string, std::unique_ptr<Compiled>> all;
  auto& found = all[text];
  if (!found) found = std::make_unique<Compiled>(text, names);
  return *found;
}

Error error_of(std::string_view text, const mu::Parser::exception_type& e) {
  std::string what = e.GetMsg();
  if (const auto at = what.find(" at position"); at != std::string::npos) what.resize(at);
  std::replace(what.begin(), what.end(), '\n', ' ');
  const auto position = static_cast<std::size_t>(std::max(0, static_cast<int>(e.GetPos())));
  return expression_error(text, std::min(position, text.size()) + 1, what, kRemedy);
}

/// muParser knows assignment and lists; an effect is one value.
Result<void> one_value(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      return tl::unexpected(expression_error(text, i + 1, "text has no place in an expression", kRemedy));
    }
    if (text[i] != '=') continue;
    const bool before = i > 0 && std::string_view("=<>!").find(text[i - 1]) != std::string_view::npos;
    const bool after = i + 1 < text.size() && text[i + 1] == '=';
    if (!before && !after)
      return tl::unexpected(
          expression_error(text, i + 1, "nothing can be assigned", "compare with ==, or leave it out"));
  }
  return {};
}

}  // namespace

Error expression_error(std::string_view text, std::size_t column, const std::string& message,
                       std::string remedy) {
  return {ErrorCode::usage,
          fmt::format("column {}: {}\n     {}\n     {:>{}}", column, message, text, "^", column),
          std::move(remedy)};
}

std::size_t column_of(std::string_view text, std::string_view name) {
  const auto word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (auto at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    const auto end = at + name.size();
    if ((at == 0 || !word(text[at - 1])) && (end == text.size() || !word(text[end]))) return at + 1;
  }
  return 1;
}

Expression::Expression(std::string text, std::vector<std::string> names)
    : text_(std::move(text)), names_(std::move(names)) {}

Result<Expression> Expression::parse(std::string_view text) {
  if (const auto ok = one_value(text); !ok) return tl::unexpected(ok.error());
  try {
    mu::Parser parser;
    define_functions(parser);
    parser.SetExpr(std::string(text));
    std::vector<std::string> names;
    for (const auto& [name, value] : parser.GetUsedVar()) names.push_back(name);
    Compiled compiled{std::string(text), names};
    std::fill(compiled.values.begin(), compiled.values.end(), 1.0);
    int values = 0;
    compiled.parser.Eval(values);
    if (values != 1)
      return tl::unexpected(
          expression_error(text, text.find(',') + 1, "this is more than one value", kRemedy));
    return Expression(std::string(text), std::move(names));
  } catch (const mu::Parser::exception_type& e) {
    return tl::unexpected(error_of(text, e));
  }
}

double Expression::operator()(std::span<const double> values) const {
  try {
    Compiled& compiled = on_this_thread(text_, names_);
    std::copy(values.begin(), values.end(), compiled.values.begin());
    return compiled.parser.Eval();
  } catch (const mu::Parser::exception_type&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace mgtd::calib::effects::formula
