// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <string>

namespace mgtd {

/// What an auxiliary input or a sensor's thermometer measures now, by the column of the pose table it is.
struct InputValue {
  std::string column;
  double value{std::numeric_limits<double>::quiet_NaN()};  ///< NaN: not known now
};

}  // namespace mgtd
