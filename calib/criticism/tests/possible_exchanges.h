// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "proto/per_sensor.h"

namespace mgtd::calib::criticism::tests {

/// possible_exchanges() lists how the connectors of an array can be mixed up, as the sensor whose readings
/// come in each place: every permutation but the identity of up to four sensors (23 of four), the exchange of
/// two sensors in larger arrays. With one sensor the list is empty.
[[nodiscard]] std::vector<PerSensor<std::size_t>> possible_exchanges(std::size_t sensors);

}  // namespace mgtd::calib::criticism::tests
