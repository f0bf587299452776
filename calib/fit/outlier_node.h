// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace mgtd::calib::fit {

/// An OutlierNode lists an observation that the other data contradict: it stays in the table, is left out of
/// the sums, and is given with the shift that would reconcile it.
struct OutlierNode {
  int pose{0};        ///< number in the table
  std::string where;  ///< "s3.z", "s3" for all three of it, "pose" for all twelve, "scalar" or "angles"
  /// Observed minus predicted; of several readings the root of the mean square.
  double shift{0};
  std::string unit;      ///< "nT", or "deg" for angles
  double sigmas{0};      ///< of the shift, when it was found
  std::size_t place{0};  ///< of the pose among those fitted
  std::string cause{};   ///< "saturated", "stuck", "a source that came and went", or empty
};

/// Whether the node speaks of this reading.
[[nodiscard]] bool covers(const OutlierNode& node, int sensor, int axis);

}  // namespace mgtd::calib::fit
