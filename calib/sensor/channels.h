// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include <string>

#include "proto/reading.h"

/// The twelve components of four sensors as one vector, sensor by sensor.
namespace mgtd::calib::sensor {

inline constexpr int kChannels = 3 * kSensors;
/// Corrected components, nT, platform frame.
using FieldVector = Eigen::Matrix<double, kChannels, 1>;
using ChannelCovariance = Eigen::Matrix<double, kChannels, kChannels>;

/// "s2.y" of channel 4.
[[nodiscard]] std::string channel_name(int channel);

}  // namespace mgtd::calib::sensor
