// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include "calib/sensor/channels.h"

namespace mgtd::calib::fit::joint {

/// over_unrolled_channels() does what sensor::over_channels() does, and unrolls the three channels of one
/// sensor besides the twelve of the cross: a recording of one sensor has tens of thousands of poses.
template <class Expression>
decltype(auto) over_unrolled_channels(Eigen::Index channels, Expression&& expression) {
  if (channels == 3) return expression(Eigen::fix<3>);
  return sensor::over_channels(channels, std::forward<Expression>(expression));
}

}  // namespace mgtd::calib::fit::joint
