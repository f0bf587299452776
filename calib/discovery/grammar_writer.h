// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "calib/discovery/grammar.h"
#include "calib/discovery/scalars.h"

/// A GrammarWriter collects the families of a grammar, one after the other, and knows the run that they are
/// for.
///
/// A family that is returned can be changed until the next one is added.
namespace mgtd::calib::discovery {

class GrammarWriter {
 public:
  explicit GrammarWriter(const LawInputs& inputs) : inputs_(inputs), scalars_(scalars_of(inputs)) {}

  [[nodiscard]] const LawInputs& inputs() const { return inputs_; }
  [[nodiscard]] const Scalars& scalars() const { return scalars_; }

  Family& add(Family family);
  Family& add(std::vector<std::string> covariates, int symbols, const Columns& columns);

  /// Functions of one scalar; `more_symbols` are those beside the scalar's own.
  Family& on(const Scalar& s, int more_symbols, const Columns& columns);
  Family& on(const Scalar& s, int more_symbols, std::vector<double> inner, std::string unit,
             std::function<Columns(double)> columns);

  /// Functions of one reading of the sensor, now or at the pose before: "ux", "prev_u".
  Family& of_reading(const std::string& name, int symbols, const Columns& columns);
  Family& of_reading(const std::string& name, int symbols, std::vector<double> inner,
                     std::function<Columns(double)> columns);
  /// Functions of several readings of a sensor: the same on each of its axes.
  Family& of_readings(std::vector<std::string> names, int symbols, const Columns& columns);
  /// Marks a family that reads this: its values differ from channel to channel.
  static Family& reads(Family& family, const std::string& name);

  /// What was collected; nothing is left in the writer.
  [[nodiscard]] Grammar take() { return std::exchange(out_, {}); }

 private:
  const LawInputs& inputs_;
  Scalars scalars_;
  Grammar out_;
};

}  // namespace mgtd::calib::discovery
