// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <random>
#include <string>
#include <vector>

#include "tests/blind/planted.h"

/// What the kinds of run draw: sizes, directions, places, dipoles.
namespace mgtd::calib::testing {

using Random = std::mt19937_64;

[[nodiscard]] double between(Random& random, double low, double high);
/// 1 or -1.
[[nodiscard]] double sign(Random& random);
/// `count` numbers whose squares add up to that of `length`, in any direction.
[[nodiscard]] std::vector<double> direction(Random& random, std::size_t count, double length);
[[nodiscard]] std::array<double, 3> vector(Random& random, double length);
[[nodiscard]] std::string sensor_at_random(Random& random);  ///< "s3"
[[nodiscard]] std::string axis_at_random(Random& random);    ///< "s3.z"
[[nodiscard]] Planted dipole_at_random(Random& random);      ///< 3 A m2, 1 to 2 m away

}  // namespace mgtd::calib::testing
