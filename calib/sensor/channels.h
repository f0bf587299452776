// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "proto/reading.h"

/// The twelve components of four sensors as one vector, sensor by sensor.
namespace mgtd::calib {

inline constexpr int kChannels = 3 * kSensors;
/// Corrected components, nT, platform frame.
using FieldVector = Eigen::Matrix<double, kChannels, 1>;
using ChannelCovariance = Eigen::Matrix<double, kChannels, kChannels>;

}  // namespace mgtd::calib
