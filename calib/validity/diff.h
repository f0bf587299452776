// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/validity/change.h"

/// diff() says whether the calibration changed between two runs, in which parameter, and by how many standard
/// errors.
namespace mgtd::calib::validity {

struct DiffReport {
  bool changed{false};  ///< no change has a probability below kChanged, or a sensor was remounted
  Change change;        ///< B less A, common rotation (and a free common scale) taken out
  std::vector<std::size_t> remounted;  ///< places of sensors whose axes were turned, mirrored or rewired
  /// Effects that only one of them has; they are not compared.
  std::vector<std::string> only_in_first, only_in_second;
  bool scale_taken_out{false};  ///< a common scale, because one of them knows no field
  CommonTurn turn;              ///< from A to B
};

/// Effects that both have are compared too. A sensor whose mounting differs counts as changed.
[[nodiscard]] DiffReport diff(const calibration::Calibration& a, const calibration::Calibration& b);

}  // namespace mgtd::calib::validity
