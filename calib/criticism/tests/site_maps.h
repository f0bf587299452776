// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "calib/criticism/tests/rows.h"

/// site_map_rows() gives the residual maps of the site: field and gradient that change smoothly with time,
/// and a constant field that varies with place up to second degree.
namespace mgtd::calib::criticism::tests {

inline constexpr int kCosines = 8;
/// The j-th of a basis of smooth functions over a run, u from -1 at its start to 1 at its end.
[[nodiscard]] inline double time_cosine(double u, int j) {
  return std::cos(j * std::numbers::pi * (u + 1) / 2);
}

struct SiteRows {
  std::string name;  ///< "site field", "site gradient", "site map"
  RowSource rows;    ///< keeps references to the problem and its state
};

/// Empty without table angles; those over time only where the poses have times.
[[nodiscard]] std::vector<SiteRows> site_map_rows(const fit::joint::JointProblem& problem,
                                                  const fit::joint::JointState& state);

}  // namespace mgtd::calib::criticism::tests
