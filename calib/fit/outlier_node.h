// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace mgtd::calib {

/// An observation that the rest of the data contradicts: still in the table, left out of the sums, listed
/// with the shift that would reconcile it.
struct OutlierNode {
  int pose{0};        ///< number in the table
  std::string where;  ///< "s3.z", "scalar" or "angles"
  double shift{0};    ///< observed minus predicted
  std::string unit;   ///< "nT", or "deg" for angles
  double sigmas{0};   ///< of the shift, when it was found
};

}  // namespace mgtd::calib
