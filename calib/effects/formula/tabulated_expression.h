// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "proto/error.h"

/// A TabulatedExpression evaluates many expressions (expression.h) of the same names, for whole
/// columns of their values at once. It is made for searches that try thousands of formulas: nothing is kept
/// of an expression that was evaluated.
namespace mgtd::calib::effects::formula {

class TabulatedExpression {
 public:
  /// The column of a name; empty where there is no such name. Asked once for each name.
  using Lookup = std::function<std::optional<Eigen::VectorXd>(const std::string& name)>;

  TabulatedExpression(Eigen::Index rows, Lookup lookup);
  ~TabulatedExpression();
  TabulatedExpression(TabulatedExpression&&) noexcept;

  /// By row; NaN where the expression has no value. Refuses what is no expression, and a name that the
  /// lookup does not know.
  [[nodiscard]] Result<Eigen::VectorXd> operator()(const std::string& text);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mgtd::calib::effects::formula
