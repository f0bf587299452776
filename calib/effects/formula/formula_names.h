// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calib/effects/effect.h"
#include "calib/effects/effect_spec.h"

/// A FormulaName says what a name in a formula stands for; formula.h lists these names.
namespace mgtd::calib::effects::formula {

struct FormulaName {
  enum class Source {
    coefficient,  ///< number `index` of the formula's own
    number,       ///< fixed, or looked for
    hours,
    temperature,  ///< of the sensor's own head
    own,          ///< the component of the field along the axis the term is for
    input,        ///< `index` of those of the level
    column,       ///< of the pose table
    history       ///< what was before the pose: history_name.h
  };
  std::string name;
  Source source{Source::column};
  std::size_t index{0};
  double number{0};
  std::function<std::optional<double>(const Pose&)> get{};  ///< of a column
};

/// A value of about this size stands for it where nothing is measured yet.
[[nodiscard]] double usual_size(const FormulaName& name, Level level);

/// `scanned`: the formula's own number, if it has one, at `value`.
[[nodiscard]] FormulaName formula_name(const std::string& name, Level level,
                                       const std::optional<std::string>& scanned, double value);

/// Columns that a formula may name on these poses: those of the format that any pose has, and all others.
[[nodiscard]] std::vector<std::string> usable_columns(const PoseTable& table);

}  // namespace mgtd::calib::effects::formula
