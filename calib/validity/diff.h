// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/validity/change.h"

/// Has the calibration changed between two runs, which parameter, by how many standard errors?
namespace mgtd::calib {

struct DiffReport {
  bool changed{false};               ///< the hypothesis of no change has a probability below kChanged
  Change change;                     ///< B less A, common rotation (and a free common scale) taken out
  std::string conclusion;            ///< one sentence: what changed, or that nothing did
  std::vector<std::string> remarks;  ///< turned sensors, effects only one of them has, the common rotation
};

/// Effects that both have are compared too. A sensor whose mounting differs is remarked and counts as
/// changed.
[[nodiscard]] DiffReport diff(const Calibration& a, const Calibration& b);

}  // namespace mgtd::calib
