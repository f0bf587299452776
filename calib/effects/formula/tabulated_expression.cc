// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/tabulated_expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <map>
#include <vector>

#include "calib/effects/formula/parser_functions.h"

namespace mgtd::calib::effects::formula {

struct TabulatedExpression::State {
  Eigen::Index rows{0};
  Lookup lookup;
  struct Name {
    double now{0};  ///< what the parser reads
    Eigen::VectorXd values;
  };
  std::map<std::string, Name> names;  ///< a node stays where it is
  mu::Parser parser;

  static double* variable(const char* name, void* self) {
    auto& state = *static_cast<State*>(self);
    auto values = state.lookup(name);
    if (!values) throw mu::ParserError(fmt::format("no '{}'", name));
    return &state.names.insert_or_assign(name, Name{0, *std::move(values)}).first->second.now;
  }
};

TabulatedExpression::TabulatedExpression(Eigen::Index rows, Lookup lookup)
    : state_(std::make_unique<State>()) {
  state_->rows = rows;
  state_->lookup = std::move(lookup);
  define_functions(state_->parser);
  state_->parser.SetVarFactory(State::variable, state_.get());
}
TabulatedExpression::~TabulatedExpression() = default;
TabulatedExpression::TabulatedExpression(TabulatedExpression&&) noexcept = default;

Result<Eigen::VectorXd> TabulatedExpression::operator()(const std::string& text) {
  Eigen::VectorXd out(state_->rows);
  try {
    // The parser's own evaluation in bulk wakes threads, which costs more than a few hundred rows do.
    state_->parser.SetExpr(text);
    std::vector<State::Name*> used;
    for (const auto& [name, variable] : state_->parser.GetUsedVar()) used.push_back(&state_->names.at(name));
    for (Eigen::Index k = 0; k < state_->rows; ++k) {
      for (State::Name* name : used) name->now = name->values[k];
      out[k] = state_->parser.Eval();
    }
  } catch (const mu::ParserError& e) {
    return fail(ErrorCode::usage, fmt::format("{}: {}", text, e.GetMsg()));
  }
  return out;
}

}  // namespace mgtd::calib::effects::formula
