// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <string>

namespace mgtd {

/// An InputValue is the present reading of an auxiliary input or thermometer, by its pose-table column.
struct InputValue {
  std::string column;
  double value{std::numeric_limits<double>::quiet_NaN()};  ///< NaN: not known now
};

}  // namespace mgtd
