// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "proto/per_sensor.h"

namespace mgtd::calib::criticism::tests {

/// Whose readings can come in each place when connectors were mixed up: every permutation but the identity of
/// up to four sensors (23 of four), the exchange of two sensors in larger arrays. None with one sensor.
[[nodiscard]] std::vector<PerSensor<std::size_t>> possible_exchanges(std::size_t sensors);

}  // namespace mgtd::calib::criticism::tests
